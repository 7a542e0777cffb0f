// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C as a polite request.
#pragma once

#include <signal.h>

#include "opaline/monitor.h"

namespace opaline {

/// While it lives, the first SIGINT or SIGTERM cancels the monitor's work; the next one of its kind kills at
/// once. Signals are the process's: the one made last has them, and at its end tells the one before of what came too late
/// for its own work.
class InterruptHandler {
 public:
  /// Catches SIGINT and SIGTERM until it is destroyed. monitor: is told of the first one.
  explicit InterruptHandler(Monitor& monitor);
  ~InterruptHandler();
  InterruptHandler(const InterruptHandler&) = delete;
  InterruptHandler& operator=(const InterruptHandler&) = delete;

 private:
  Monitor& monitor_;
  Monitor* before_;
  struct sigaction old_interrupt_ {
  }, old_terminate_{};
};

}  // namespace opaline
