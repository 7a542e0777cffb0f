// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/process_start.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>

namespace opaline {

void prepare_process() {
  // The lowest number that is free is the one that was found closed. For reading only: a result that nobody
  // can receive is then told from one that was delivered.
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor)
    if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF && ::open("/dev/null", O_RDONLY) != descriptor)
      std::_Exit(3);  // no descriptor to say it on
  std::signal(SIGXFSZ, SIG_IGN);
}

bool was_started_without_output() {
  return (::fcntl(STDOUT_FILENO, F_GETFL) & O_ACCMODE) == O_RDONLY;
}

}  // namespace opaline
