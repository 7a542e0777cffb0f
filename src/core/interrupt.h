// SPDX-License-Identifier: GPL-3.0-or-later
// Cancellation by Ctrl-C.
#pragma once

#include <signal.h>

#include "opaline/monitor.h"

namespace opaline {

/// During its lifetime, the first SIGINT or SIGTERM cancels the monitor's work; the next one of the same kind
/// kills at once. Signals are global: the newest handler receives them, and at its end forwards late ones to
/// the previous handler.
class InterruptHandler {
 public:
  /// Catches SIGINT and SIGTERM until destroyed. monitor: cancelled by the first one.
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
