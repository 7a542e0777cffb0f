// SPDX-License-Identifier: GPL-3.0-or-later
// The program as a child process, with what it printed.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "../core/ball_file.h"

namespace opaline {

struct Outcome {
  int exit_code = -1;  ///< -1: killed
  int signal = 0;      ///< that killed it
  std::string out, err;
};

/// Bounds on a child; none by default.
struct Limits {
  std::optional<rlim_t> file_size, address_space;  ///< bytes
  std::vector<int> closed = {};                    ///< descriptors that it is started without
};

class Child {
 public:
  explicit Child(const std::vector<std::string>& arguments, const std::string& folder = ".",
                 const Limits& limits = {}) {
    std::vector<std::string> words{OPALINE_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string out = prints_.file("out"), err = prints_.file("err");
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("no child process");
    if (pid_ > 0) return;
    limit(RLIMIT_FSIZE, limits.file_size);
    limit(RLIMIT_AS, limits.address_space);
    std::signal(SIGXFSZ, SIG_DFL);
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    for (const int descriptor : limits.closed) ::close(descriptor);
    if (::chdir(folder.c_str()) == 0) ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~Child() {
    if (pid_ > 0) wait(0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  void send(int signal) const { ::kill(pid_, signal); }

  /// Waits until its standard output holds the text; false after the time.
  bool prints(const std::string& text, double seconds = 60) const {
    return within(seconds, [&] { return bytes_of(prints_.file("out")).find(text) != std::string::npos; });
  }

  /// The same of its standard error.
  bool complains(const std::string& text, double seconds = 60) const {
    return within(seconds, [&] { return bytes_of(prints_.file("err")).find(text) != std::string::npos; });
  }

  /// Its end; killed (signal SIGKILL) if it takes longer.
  Outcome wait(double seconds = 120) {
    int status = 0;
    if (!within(seconds, [&] { return ::waitpid(pid_, &status, WNOHANG) == pid_; })) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, &status, 0);
    }
    pid_ = -1;
    Outcome outcome;
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
    outcome.out = bytes_of(prints_.file("out"));
    outcome.err = bytes_of(prints_.file("err"));
    return outcome;
  }

 private:
  static void limit(int resource, const std::optional<rlim_t>& bytes) {
    if (!bytes) return;
    const rlimit both{*bytes, *bytes};
    ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
  }

  template <class Condition>
  static bool within(double seconds, const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }

  ScratchFolder prints_;
  pid_t pid_ = -1;
};

inline Outcome run_program(const std::vector<std::string>& arguments, const std::string& folder = ".",
                           const Limits& limits = {}) {
  return Child(arguments, folder, limits).wait();
}

/// Not in a root without /dev/pts.
inline bool has_terminals() {
  int terminal = -1, program = -1;
  if (::openpty(&terminal, &program, nullptr, nullptr, nullptr) != 0) return false;
  ::close(terminal);
  ::close(program);
  return true;
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// One JSON object a line; a test failure where a line is none.
inline std::vector<nlohmann::json> events_of(const std::string& text) {
  std::vector<nlohmann::json> events;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    events.push_back(nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false));
    EXPECT_TRUE(events.back().is_object() && events.back().contains("event")) << line;
  }
  return events;
}

/// The first event of a kind; null and a test failure if there is none.
inline nlohmann::json event_of(const std::vector<nlohmann::json>& events, const std::string& kind) {
  for (const nlohmann::json& event : events)
    if (event.value("event", "") == kind) return event;
  ADD_FAILURE() << "no event " << kind;
  return {};
}

/// A folder with a small scene in it: a marble ball under a point light, 32 x 32 pixels, some 500 samples.
struct SceneFolder : ScratchFolder {
  std::string scene = file("ball.json");

  SceneFolder() {
    put_bytes(scene, R"({
  "media": {"marble": {"preset": "marble"}},
  "shapes": [{"name": "ball", "file": ")" +
                         ball_file(10) +
                         R"(", "medium": "marble"}],
  "lights": [{"name": "key", "type": "point", "position": [20, 30, 40], "intensity": 1000}],
  "camera": {"position": [0, 0, 50]},
  "film": {"resolution": [32, 32]},
  "settings": {"method": "hierarchical", "samples": 500}
}
)");
  }
};

}  // namespace opaline
