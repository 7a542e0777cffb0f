// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/process_start.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <string_view>

#include "core/out_of_memory.h"

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

}  // namespace

void prepare_process() {
  // open returns the lowest free number, the closed descriptor found. Read-only, so writing fails and an
  // undeliverable result is detected.
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor)
    if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF && ::open("/dev/null", O_RDONLY) != descriptor)
      std::_Exit(3);  // no descriptor for a message
  std::signal(SIGXFSZ, SIG_IGN);
}

bool was_started_without_output() {
  return (::fcntl(STDOUT_FILENO, F_GETFL) & O_ACCMODE) == O_RDONLY;
}

}  // namespace opaline
