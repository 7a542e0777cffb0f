// SPDX-License-Identifier: GPL-3.0-or-later
// The documentation as a reader follows it: its commands and links.
#include <algorithm>
#include <cctype>
#include <regex>
#include <set>

#include "run_program.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

const fs::path root = fs::path(OPALINE_README).parent_path();

/// README and the pages that it links to, in the order in which their commands build on each other.
std::vector<fs::path> pages_with_commands() {
  std::vector<fs::path> pages{root / "README.md"};
  for (const char* name : {"rendering", "assets", "appearance", "view", "frames"})
    pages.push_back(root / "docs" / (std::string(name) + ".md"));
  pages.push_back(root / "bench/README.md");
  return pages;
}

/// The commands between ``` lines, without their comments, a line each; a backslash joins two.
std::vector<std::string> commands_of(const fs::path& page) {
  std::istringstream lines(bytes_of(page.string()));
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

// Claim: every file that a command of the documentation reads is in a fresh clone, after ./scenes/demo, or was
// written by a command above it; what commands write goes to scenes/out, which git ignores. Source: the
// README. Fails if: a command names a file of the reader's own, such as scene.json.
TEST(Documentation, CommandsReadExistingFiles) {
  const std::set<std::string> writers{"-o", "--error-picture", "--cache", "--resume"};
  std::vector<std::string> commands;
  for (const fs::path& page : pages_with_commands())
    for (std::string& command : commands_of(page)) commands.push_back(std::move(command));
  EXPECT_GT(commands.size(), 30u);
  std::set<std::string> written;
  for (const std::string& command : commands) {
    std::istringstream words(command);
    std::string before;
    for (std::string word; words >> word; before = word) {
      const bool is_path = word.find('/') != std::string::npos || word.ends_with(".json") ||
                           word.ends_with(".exr") || word.ends_with(".png");
      if (!is_path || word == "build/src/opaline" || before == "--part") continue;
      if (writers.contains(before)) {
        EXPECT_TRUE(word.starts_with("scenes/out/")) << command;
        written.insert(word);
        const std::size_t frame = word.find("####");
        if (frame == word.npos) continue;
        written.insert(std::string(word).replace(frame, 4, "0001"));
        written.insert(std::string(word).replace(frame, 4, "0002"));
        continue;
      }
      const std::string folder = word.substr(0, word.rfind('/'));
      EXPECT_TRUE(written.contains(word) || written.contains(folder) || fs::exists(root / word))
          << word << " in: " << command;
    }
  }
}

/// Anchors of a page, as GitHub makes them of its headings.
std::set<std::string> anchors_of(const fs::path& page) {
  std::istringstream lines(bytes_of(page.string()));
  std::set<std::string> anchors;
  bool is_block = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) is_block = !is_block;
    if (is_block || !line.starts_with('#')) continue;
    std::string anchor;
    for (const char c : line.substr(line.find_first_not_of('#') + 1))
      if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == ' ')
        anchor += c == ' ' ? '-' : char(std::tolower(static_cast<unsigned char>(c)));
    anchors.insert(anchor);
  }
  return anchors;
}

std::vector<fs::path> pages() {
  std::vector<fs::path> pages{root / "README.md", root / "CHANGELOG.md"};
  for (const char* folder : {"docs", "bench", "scenes", "src", ".github"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".md") pages.push_back(entry.path());
  return pages;
}

// Claim: every link within the repository leads to a file, and to a heading of it. README has at most 8 kB. Source: the headings.
// Fails if: a page is moved, or a heading renamed, without its links.
TEST(Documentation, LinksLead) {
  EXPECT_LE(fs::file_size(root / "README.md"), 8000u);
  const std::regex link(R"(\]\(([^)#\s]*)(?:#([^)\s]*))?\))");
  std::size_t links = 0;
  for (const fs::path& page : pages()) {
    const std::string text = bytes_of(page.string());
    for (std::sregex_iterator found(text.begin(), text.end(), link), end; found != end; ++found) {
      const std::string path = (*found)[1], anchor = (*found)[2];
      if (path.starts_with("http")) continue;
      const fs::path target = path.empty() ? page : page.parent_path() / path;
      ASSERT_TRUE(fs::exists(target)) << found->str() << " of " << page;
      EXPECT_TRUE(anchor.empty() || anchors_of(target).contains(anchor)) << found->str() << " of " << page;
      ++links;
    }
  }
  EXPECT_GT(links, 50u);
}

}  // namespace
}  // namespace opaline
