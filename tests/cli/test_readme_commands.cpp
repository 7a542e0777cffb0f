// SPDX-License-Identifier: GPL-3.0-or-later
// The commands of the README as a reader copies them.
#include <set>

#include "run_program.h"

namespace opaline {
namespace {

/// The commands between ``` lines, without their comments, a line each; a backslash joins two.
std::vector<std::string> readme_commands() {
  std::istringstream lines(bytes_of(OPALINE_README));
  std::vector<std::string> commands;
  bool is_block = false, goes_on = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      is_block = !is_block && line == "```";
      continue;
    }
    if (!is_block || !(goes_on || line.starts_with("build/src/opaline "))) continue;
    line = line.substr(0, line.find(" #"));
    if (goes_on)
      commands.back() += line;
    else
      commands.push_back(line);
    goes_on = line.ends_with('\\');
    if (goes_on) commands.back().pop_back();
  }
  return commands;
}

// Claim: every file that a command of the README reads is in a fresh clone, after ./scenes/demo, or was
// written by a command above it; what commands write goes to scenes/out, which git ignores. Source: the
// README. Fails if: a command names a file of the reader's own, such as scene.json.
TEST(ReadmeCommands, ReadWhatIsThere) {
  const std::filesystem::path root = std::filesystem::path(OPALINE_README).parent_path();
  const std::set<std::string> writers{"-o", "--error-picture", "--cache", "--resume"};
  const std::vector<std::string> commands = readme_commands();
  EXPECT_GT(commands.size(), 15u);
  std::set<std::string> written;
  for (const std::string& command : commands) {
    std::istringstream words(command);
    std::string before;
    for (std::string word; words >> word; before = word) {
      const bool is_path = word.find('/') != std::string::npos || word.ends_with(".json") ||
                           word.ends_with(".exr") || word.ends_with(".png");
      if (!is_path || word == "build/src/opaline") continue;
      if (writers.contains(before)) {
        EXPECT_TRUE(word.starts_with("scenes/out/")) << command;
        written.insert(word);
        continue;
      }
      const std::string folder = word.substr(0, word.rfind('/'));
      EXPECT_TRUE(written.contains(word) || written.contains(folder) || std::filesystem::exists(root / word))
          << word << " in: " << command;
    }
  }
}

}  // namespace
}  // namespace opaline
