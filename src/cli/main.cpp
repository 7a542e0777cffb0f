// SPDX-License-Identifier: GPL-3.0-or-later
// Catches all exceptions and converts them to exit codes.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>

#include "cli/commands.h"
#include "core/out_of_memory.h"
#include "opaline/error.h"

namespace opaline {
namespace {

/// Allocates nothing.
[[noreturn]] void end_by_exception() {
  try {
    if (const std::exception_ptr failure = std::current_exception()) std::rethrow_exception(failure);
  } catch (const std::exception& failure) {
    if (is_out_of_memory(failure)) {
      constexpr std::string_view text = "opaline: error: out of memory\n";
      if (::write(STDERR_FILENO, text.data(), text.size()) >= 0) std::_Exit(3);
    }
  } catch (...) {
  }
  std::abort();
}

void catch_from_the_start() {
  std::set_terminate(end_by_exception);
}

// Runs before the libraries' constructors, as they allocate.
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_libraries)() = catch_from_the_start;

/// Call first in main. Opens closed descriptors 0 to 2 as /dev/null, so messages never reach an output file
/// opened under their number; writing to them still fails. Writing beyond the file size limit then fails
/// instead of ending the process with its temporary file left behind. (An out-of-memory exception escaping a
/// library ends the process as from main, with one line and exit code 3, even before main.)
void prepare_process() {
  // open returns the lowest free number, the closed descriptor found. Read-only, so writing fails and an
  // undeliverable result is detected.
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor)
    if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF && ::open("/dev/null", O_RDONLY) != descriptor)
      std::_Exit(3);  // no descriptor for a message
  std::signal(SIGXFSZ, SIG_IGN);
}

/// True if standard output came closed.
bool was_started_without_output() {
  return (::fcntl(STDOUT_FILENO, F_GETFL) & O_ACCMODE) == O_RDONLY;
}

}  // namespace
}  // namespace opaline

namespace {

int run(const opaline::Command& command) {
  if (const auto* show = std::get_if<opaline::ShowText>(&command)) opaline::write_line(stdout, show->text);
  if (const auto* render = std::get_if<opaline::RenderArguments>(&command)) opaline::render_command(*render);
  if (const auto* turntable = std::get_if<opaline::TurntableArguments>(&command))
    opaline::turntable_command(*turntable);
  if (const auto* merge = std::get_if<opaline::MergeArguments>(&command)) opaline::merge_command(*merge);
  if (const auto* precompute = std::get_if<opaline::PrecomputeArguments>(&command))
    opaline::precompute_command(*precompute);
  if (const auto* info = std::get_if<opaline::InfoArguments>(&command)) opaline::info_command(*info);
  if (const auto* import = std::get_if<opaline::ImportArguments>(&command)) opaline::import_command(*import);
  if (const auto* compare = std::get_if<opaline::CompareArguments>(&command))
    return opaline::compare_command(*compare);
  if (const auto* bench = std::get_if<opaline::BenchArguments>(&command))
    return opaline::bench_command(*bench);
  if (const auto* profile = std::get_if<opaline::ProfileArguments>(&command))
    opaline::profile_command(*profile);
  if (const auto* view = std::get_if<opaline::ViewArguments>(&command)) opaline::view_command(*view);
  if (const auto* cache = std::get_if<opaline::CacheArguments>(&command))
    return opaline::cache_command(*cache);
  return 0;
}

opaline::Log log_of(const opaline::Command& command) {
  return std::visit(
      [](const auto& arguments) {
        if constexpr (requires { arguments.log; })
          return arguments.log;
        else
          return opaline::Log{};
      },
      command);
}

/// True if the log has no receiver: the program was started without standard output, and its results are
/// files or a page.
bool is_unwanted_log(const opaline::Command& command) {
  const bool is_log = std::holds_alternative<opaline::RenderArguments>(command) ||
                      std::holds_alternative<opaline::TurntableArguments>(command) ||
                      std::holds_alternative<opaline::MergeArguments>(command) ||
                      std::holds_alternative<opaline::PrecomputeArguments>(command) ||
                      std::holds_alternative<opaline::ViewArguments>(command);
  return is_log && opaline::was_started_without_output();
}

}  // namespace

int main(int argc, char** argv) {
  opaline::prepare_process();
  opaline::Log log;
  if (opaline::asks_for_json(argc, argv))
    log.format = opaline::LogFormat::json;  // also for errors in the options
  try {
    const opaline::Command command = opaline::parse_arguments(argc, argv);
    log = log_of(command);
    const int code = run(command);
    if (std::ferror(stdout) != 0 && !is_unwanted_log(command))
      throw opaline::run_failed("stdout", "cannot write");
    return code;
  } catch (const opaline::Error& failure) {
    return opaline::print_failure(log, opaline::placed_at_option(failure, argc, argv));
  } catch (const std::exception& failure) {
    return opaline::print_failure(log, failure);
  }
}
