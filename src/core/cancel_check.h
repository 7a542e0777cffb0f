// SPDX-License-Identifier: GPL-3.0-or-later
// Cancellation of stages without progress: they have no monitor, and check that of the enclosing work.
#pragma once

#include "opaline/monitor.h"

namespace opaline {

/// During its lifetime, this thread works for the caller of a monitor.
class CancelScope {
 public:
  /// monitor: null: no cancellation
  explicit CancelScope(Monitor* monitor);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  Monitor* before_;
};

/// Constructed by the thread beginning a stage, for the loops of all its threads; cheap enough for each
/// comparison of a sort.
class CancelCheck {
 public:
  CancelCheck();

  /// error Error{interrupted}: the caller has cancelled
  void operator()() const {
    if (monitor_ != nullptr && monitor_->cancelled.load(std::memory_order_relaxed)) advance(monitor_, 0);
  }

 private:
  Monitor* monitor_;
};

}  // namespace opaline
