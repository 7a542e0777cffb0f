// SPDX-License-Identifier: GPL-3.0-or-later
// Cancellation of stages that report no progress: they have no monitor, and look at that of the work they are part of.
#pragma once

#include "opaline/monitor.h"

namespace opaline {

/// While it lives, this thread works for the caller of a monitor.
class CancelScope {
 public:
  /// monitor: null: nobody cancels
  explicit CancelScope(Monitor* monitor);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  Monitor* before_;
};

/// Made by the thread beginning a stage, for the loops of all its threads; cheap enough for each comparison of a sort.
class CancelCheck {
 public:
  CancelCheck();

  /// error Error{interrupted}: the caller asked to stop
  void operator()() const {
    if (monitor_ != nullptr && monitor_->cancelled.load(std::memory_order_relaxed)) advance(monitor_, 0);
  }

 private:
  Monitor* monitor_;
};

}  // namespace opaline
