// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/progress.h"
#include "opaline/error.h"

namespace opaline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPollMilliseconds = 50;
constexpr std::chrono::seconds kGrace{5};  // to save its sums

/// In the child, between fork and exec: system calls only.
[[noreturn]] void become_program(char** argv, int output, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::execv("/proc/self/exe", argv);
  ::_exit(127);
}

/// A running child; its output ends when it does.
class Process {
 public:
  explicit Process(const std::vector<std::string>& arguments) {
    std::vector<std::string> words{"opaline"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
      throw run_failed("", std::string("cannot create a pipe: ") + std::strerror(errno));
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ == 0) become_program(argv.data(), ends[1], parent);
    ::close(ends[1]);
    output_ = ends[0];
    if (pid_ > 0) return;
    ::close(output_);
    throw run_failed("", std::string("cannot start a child process: ") + std::strerror(errno));
  }
  ~Process() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      wait();
    }
    ::close(output_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Reads available output, waiting a moment at most; false at the end.
  bool read_some(std::string& text) {
    pollfd ready{output_, POLLIN, 0};
    if (::poll(&ready, 1, kPollMilliseconds) <= 0) return true;
    char bytes[65536];
    const ssize_t count = ::read(output_, bytes, sizeof bytes);
    if (count > 0) text.append(bytes, std::size_t(count));
    return count > 0 || (count < 0 && errno == EINTR);
  }

  void ask_to_stop() const { ::kill(pid_, SIGTERM); }

  /// Its status; the account of the kernel in usage().
  int wait() {
    int status = 0;
    while (::wait4(pid_, &status, 0, &usage_) < 0 && errno == EINTR) continue;
    pid_ = -1;
    return status;
  }
  const rusage& usage() const { return usage_; }

 private:
  pid_t pid_ = -1;
  int output_ = -1;
  rusage usage_{};
};

double seconds(const timeval& t) {
  return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
}

/// Shows the child's last progress event on a terminal.
class ChildProgress {
 public:
  void show(std::string_view output) {
    const std::size_t end = output.rfind('\n');
    if (!TerminalLine::is_to_be_had() || end == std::string_view::npos || end == end_) return;
    end_ = end;
    const std::size_t before = end == 0 ? std::string_view::npos : output.rfind('\n', end - 1),
                      begin = before == std::string_view::npos ? 0 : before + 1;
    const Json event = Json::parse(output.substr(begin, end - begin), nullptr, /*allow_exceptions=*/false);
    if (!event.is_object() || event.value("event", "") != "progress") return;
    line_.show(ProgressState{event.value("stage", ""), event.value("fraction", -1.),
                             event.value("seconds_left", -1.)});
  }

 private:
  std::size_t end_ = std::string::npos;
  TerminalLine line_;
};

/// Reads until the child ends, or a cancelled child exceeds its grace period.
std::string output_of(Process& process, const Monitor& monitor) {
  std::string text;
  bool asked = false;
  Clock::time_point deadline;
  ChildProgress progress;
  while (process.read_some(text)) {
    progress.show(text);
    if (!monitor.cancelled) continue;
    if (!asked) {
      process.ask_to_stop();
      deadline = Clock::now() + kGrace;
      asked = true;
    } else if (Clock::now() > deadline) {
      break;
    }
  }
  return text;
}

/// Its last error message, or its exit status without one.
std::string failure_of(int status, const OwnChild& child, const std::string& last_line) {
  if (status == 0) return {};
  if (const Json* error = child.event("error")) return error->value("message", "");
  const std::string end = WIFSIGNALED(status) ? fmt::format("killed by signal {} ({})", WTERMSIG(status),
                                                            strsignal(WTERMSIG(status)))
                                              : fmt::format("exit code {}", WEXITSTATUS(status));
  return last_line.empty() ? end : end + ": " + last_line;
}

}  // namespace

const Json* OwnChild::event(const std::string& kind) const {
  const auto at = std::ranges::find_if(events, [&](const Json& e) { return e.value("event", "") == kind; });
  return at == events.end() ? nullptr : &*at;
}

OwnChild run_own_child(const std::vector<std::string>& arguments, Monitor& monitor) {
  advance(&monitor, 0);
  const Clock::time_point start = Clock::now();
  Process process(arguments);
  const std::string output = output_of(process, monitor);
  advance(&monitor, 0);
  const int status = process.wait();
  const std::chrono::duration<double> wall = Clock::now() - start;

  OwnChild child;
  const rusage& usage = process.usage();
  child.cost = {seconds(usage.ru_utime), seconds(usage.ru_stime), wall.count(),
                double(usage.ru_maxrss) * 1024};
  std::istringstream lines(output);
  std::string last_line;
  for (std::string line; std::getline(lines, line);) {
    Json event = Json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (event.is_object() && event.contains("event"))
      child.events.push_back(std::move(event));
    else
      last_line = line;
  }
  child.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : int(ErrorKind::run_failed);
  child.failure = failure_of(status, child, last_line);
  if (child.exit_code == int(ErrorKind::interrupted))
    throw Error(ErrorKind::interrupted, {}, 0, 0, child.failure);
  return child;
}

BenchRun bench_run(const OwnChild& render) {
  const Json* done = render.event("done");
  if (done == nullptr) throw run_failed("", "a child process returned no result");
  BenchRun run;
  run.job = render.cost;
  run.samples = done->value("samples", 0.0);
  run.queries = done->value("queries", 0.0);
  run.entry_samples = done->value("entry_samples", 0.0);
  run.rays = done->value("shading_rays", 0.0);
  run.embree_seconds = done->value("embree_cpu_seconds", 0.0);
  for (const Json& stage : done->at("stages")) {
    const std::string name = stage.value("stage", "");
    const auto at = std::ranges::find(kBenchStages, name);
    if (at == kBenchStages.end()) throw run_failed("", "the stage " + name + " is not in kBenchStages");
    const double cpu = stage.value("cpu_seconds", 0.0), system = stage.value("system_seconds", 0.0);
    run.stages[std::size_t(at - kBenchStages.begin())] = {
        cpu - system, system, stage.value("wall_seconds", 0.0), stage.value("peak_memory_bytes", 0.0)};
  }
  return run;
}

}  // namespace opaline
