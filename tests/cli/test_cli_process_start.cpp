// SPDX-License-Identifier: GPL-3.0-or-later
// What a program is started with: closed descriptors, bounds on its files and its memory.
#include <gtest/gtest.h>

#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

// Claim: a process without standard descriptors, as daemons start them, writes the same picture as one that
// has them: its messages go nowhere, not into the file that got their descriptor. 20 runs each but the last,
// since which file got it depends on the threads. Tolerance: none. Fails if: main does not fill descriptors 0
// to 2 (18 of 20 pictures could not be read then).
TEST(CliProcessStart, ClosedDescriptors) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr");
  const auto rendered = [&](const std::vector<std::string>& log, const std::vector<int>& closed) {
    std::vector<std::string> arguments{"render", folder.scene, "-o", out, "--resolution", "16x16"};
    arguments.insert(arguments.end(), log.begin(), log.end());
    std::filesystem::remove(out);
    const Outcome outcome =
        run_program(arguments, ".", {.file_size = {}, .address_space = {}, .closed = closed});
    EXPECT_EQ(outcome.exit_code, 0);
    return bytes_of(out);
  };
  const std::string picture = rendered({}, {});
  ASSERT_FALSE(picture.empty());
  const struct {
    std::vector<std::string> log;
    std::vector<int> closed;
    int runs;
  } starts[] = {{{}, {2}, 20}, {{"--log", "json"}, {1}, 20}, {{}, {0, 1, 2}, 3}};
  for (const auto& start : starts)
    for (int run = 0; run < start.runs; ++run)
      ASSERT_TRUE(rendered(start.log, start.closed) == picture)
          << "run " << run << ", " << start.closed.size();
}

// Claim: a result that nobody can receive is an error, as if the descriptor had stayed closed. Fails if: it
// is opened for writing to /dev/null.
TEST(CliProcessStart, ResultForNobody) {
  const SceneFolder folder;
  std::filesystem::create_directory(folder.file("cache"));
  const Outcome outcome = run_program({"cache", "ls", folder.file("cache")}, ".",
                                      {.file_size = {}, .address_space = {}, .closed = {1}});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_TRUE(contains(outcome.err, "stdout: cannot write")) << outcome.err;
}

// Claim: what a full disk cannot take of the log is an error of every command, and costs no picture; a reader that has left
// is none. Fails if: the log of a rendering is not looked at, or an error goes where nobody can read it.
TEST(CliProcessStart, FullDiskUnderTheLog) {
  const SceneFolder folder;
  const auto run = [&](const std::string& words, const std::string& out) {
    const std::string command = "'" OPALINE_PROGRAM "' " + words + " 2>'" + folder.file("err") + "' " + out;
    return WEXITSTATUS(std::system(command.c_str()));
  };
  const std::string picture = folder.file("a.exr"),
                    render = "render '" + folder.scene + "' -o '" + picture + "'";
  for (const std::string& words :
       {render, render + " --log json", "compare '" + picture + "' '" + picture + "' --json",
        std::string("--version")}) {
    EXPECT_EQ(run(words, ">/dev/full"), 3) << words;
    EXPECT_TRUE(contains(bytes_of(folder.file("err")), "stdout: cannot write")) << words;
    EXPECT_FALSE(read_image(picture).pixels.empty());
  }
  const std::string code = folder.file("code"), left = "{ '" OPALINE_PROGRAM "' " + render + " 2>'" +
                                                       folder.file("err") + "'; echo $? >'" + code +
                                                       "'; } | true";
  ASSERT_EQ(std::system(left.c_str()), 0);
  EXPECT_EQ(bytes_of(code), "0\n");
  EXPECT_EQ(bytes_of(folder.file("err")).find("cannot write"), std::string::npos);
}

#ifndef __SANITIZE_ADDRESS__  // which needs more address space than the limits
// Claim: whatever the address space, from what the program takes to start up to what the scene needs, a
// picture is made or "out of memory" is said and nothing is left behind. Fails if: Embree's failures, or that
// no thread can be started, count as defects (SIGABRT below 290 MB).
TEST(CliProcessStart, LittleAddressSpace) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr");
  int failed = 0;
  for (rlim_t megabytes = 160; megabytes < 340; megabytes += 12) {
    const Outcome outcome = run_program({"render", folder.scene, "-o", out, "--quiet"}, ".",
                                        {.file_size = {}, .address_space = megabytes << 20, .closed = {}});
    ASSERT_EQ(outcome.signal, 0) << megabytes << " MB: " << outcome.err;
    if (outcome.exit_code == 0) continue;
    ++failed;
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_TRUE(contains(outcome.err, "out of memory")) << megabytes << " MB: " << outcome.err;
    std::filesystem::remove(out);
    EXPECT_EQ(folder.entries(), 1u);
  }
  EXPECT_GT(failed, 0);
}
#endif

}  // namespace
}  // namespace opaline
