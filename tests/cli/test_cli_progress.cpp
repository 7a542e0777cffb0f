// SPDX-License-Identifier: GPL-3.0-or-later
// What is shown while the program works: on a terminal, in a file, and over a range of frames.
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>

#include <algorithm>

#include "run_program.h"

namespace opaline {
namespace {

/// The program on a terminal of its own, which keeps all that was written to it.
class Terminal {
 public:
  Terminal(const std::vector<std::string>& arguments, unsigned short columns) {
    std::vector<std::string> words{OPALINE_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    winsize size{40, columns, 0, 0};
    child_ = ::forkpty(&terminal_, nullptr, nullptr, &size);
    if (child_ < 0)
      throw std::runtime_error("no pseudo terminal");  // and never a signal to all processes, which is -1
    if (child_ == 0) {
      ::setenv("TERM", "xterm", 1);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
  }
  ~Terminal() {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    ::close(terminal_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void resize(unsigned short columns) const {
    winsize size{40, columns, 0, 0};
    ::ioctl(terminal_, TIOCSWINSZ, &size);
  }
  void interrupt() const { ::kill(child_, SIGINT); }

  /// Reads until the text holds that part, or the program is at its end, or the time is over; what was read.
  std::string read_until(const std::string& part, double seconds = 60) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    std::string text;
    while (!contains(text, part) && std::chrono::steady_clock::now() < end) {
      pollfd ready{terminal_, POLLIN, 0};
      if (::poll(&ready, 1, 100) <= 0) continue;
      char buffer[4096];
      const ssize_t count = ::read(terminal_, buffer, sizeof buffer);
      if (count <= 0) break;
      text.append(buffer, std::size_t(count));
    }
    return text;
  }

 private:
  int terminal_ = -1;
  pid_t child_ = -1;
};

/// The lines that stood in the place of the progress, one render at a time.
std::vector<std::string> progress_lines(const std::string& text) {
  const std::string clear = "\r\x1b[K";
  std::vector<std::string> lines;
  for (std::size_t at = text.find(clear); at != std::string::npos;) {
    const std::size_t begin = at + clear.size(), next = text.find(clear, begin);
    const std::string line = text.substr(begin, next - begin);
    if (line.find('\n') == std::string::npos && next != std::string::npos) lines.push_back(line);
    at = next;
  }
  return lines;
}

std::vector<std::string> endless(const SceneFolder& folder) {
  return {"render", folder.scene,    "-o",      folder.file("a.exr"), "--method",
          "direct", "--until-error", "0.0001%", "--resolution",       "128x128"};
}

// Claim: the progress stays within the terminal's width, also after the terminal was made narrower, and has a
// bar where there is room; it never says 100 %, and time is left while work is. After Ctrl-C the program says
// that nothing was kept without --resume. Source: progress.h. Fails if: a line is as long as the terminal is
// wide or longer (it would wrap, and stay).
TEST(CliProgress, FitsTheTerminal) {
  if (!has_terminals()) GTEST_SKIP() << "no pseudo terminals here";
  const SceneFolder folder;
  Terminal terminal(endless(folder), 60);
  const std::string wide = terminal.read_until(" left", 60);
  ASSERT_TRUE(contains(wide, " left")) << wide;
  EXPECT_TRUE(contains(wide, "[.")) << wide;
  for (const std::string& line : progress_lines(wide)) EXPECT_LT(line.size(), 60u) << line;
  terminal.resize(24);
  terminal.read_until("\r\x1b[K");  // may have been on its way
  const std::string narrow = terminal.read_until("never", 1.5);
  ASSERT_FALSE(progress_lines(narrow).empty());
  for (const std::string& line : progress_lines(narrow)) EXPECT_LT(line.size(), 24u) << line;
  for (const std::string& text : {wide, narrow}) {
    EXPECT_FALSE(contains(text, "100 %"));
    EXPECT_FALSE(contains(text, " 0.0 s left"));
  }
  terminal.interrupt();
  EXPECT_TRUE(contains(terminal.read_until("--resume FILE"), "interrupted; no sums are stored"));
}

// Claim: where no terminal is, short stages print nothing to standard error, so that a range of frames in a
// job's log does not drown it; a summary of the range ends standard output. Source: progress.h. Fails if:
// each stage writes a line when it starts.
TEST(CliProgress, IsQuietInALog) {
  const SceneFolder folder;
  const std::vector<std::string> line{"render",   folder.scene, "-o",       folder.file("a.##.exr"),
                                      "--frames", "1-3",        "--method", "lambert"};
  const Outcome outcome = run_program(line);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(contains(outcome.out, "\n3 of 3 frames rendered in ")) << outcome.out;
  EXPECT_TRUE(contains(run_program(line).out, "\n0 of 3 frames rendered, 3 skipped in "));
}

// Claim: over a range of frames the terminal's line is about all of it: which frame of how many. Source:
// progress.h. Fails if: each frame starts from 0 %.
TEST(CliProgress, OneLineForAllFrames) {
  if (!has_terminals()) GTEST_SKIP() << "no pseudo terminals here";
  const SceneFolder folder;
  Terminal terminal(
      {"render", folder.scene, "-o", folder.file("a.##.exr"), "--frames", "1-4", "--resolution", "256x256"},
      80);
  const std::string text = terminal.read_until("4 of 4 frames rendered");
  ASSERT_TRUE(contains(text, "4 of 4 frames rendered")) << text;
  EXPECT_TRUE(contains(text, "frame 1 of 4  [........................] 0 %  ("));
  EXPECT_TRUE(contains(text, "frame 3 of 4  [############............] 50 %, "));
}

// Claim: a blank stands behind the longest name of a stage, and a bench shows how far a reference is. Source: progress.h.
// Fails if: a name of more than eleven letters runs into its bar, or a child's progress goes nowhere.
TEST(CliProgress, ProfilesAndReferences) {
  if (!has_terminals()) GTEST_SKIP() << "no pseudo terminals here";
  const SceneFolder folder;
  Terminal profile({"profile", "spectralon", "--walks", "100000000"}, 80);
  EXPECT_TRUE(contains(profile.read_until("diffuse [", 20), "walks R, diffuse ["));
  Terminal bench(
      {"bench", folder.scene, "--csv", folder.file("a.csv"), "--quick", "--reference-error", "0.01%"}, 80);
  EXPECT_TRUE(contains(bench.read_until("\x1b[Kshading ", 20), "%"));
}

// Claim: while settings are chosen the progress tells so, with what is being tried, and no share of it: how many
// trials there will be is not known. Source: progress.h. Fails if: a trial's own stages stand in place of the search
// ("shading 99 %").
TEST(CliProgress, ASearchIsNoneOfItsTrials) {
  const SceneFolder folder;
  const Outcome outcome = run_program({"render", folder.scene, "-o", folder.file("a.exr"), "--target-error",
                                       "1%", "--resolution", "256x256", "--log", "json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  bool is_chosen = false;
  std::size_t searching = 0;
  for (std::string line; std::getline(lines, line);) {
    const nlohmann::json event = nlohmann::json::parse(line);
    is_chosen = is_chosen || event.value("event", "") == "target";
    if (event.value("event", "") != "progress" || event.value("stage", "") == "loading" || is_chosen)
      continue;
    EXPECT_EQ(event.value("stage", ""), "choosing") << line;
    EXPECT_FALSE(event.contains("fraction")) << line;
    ++searching;
  }
  EXPECT_GT(searching, 0u);
  EXPECT_TRUE(is_chosen) << outcome.out;
}

}  // namespace
}  // namespace opaline
