// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/interrupt.h"

#include <atomic>

namespace opaline {
namespace {

// A signal handler has no other way to reach data; lock-free, so it may.
std::atomic<Monitor*> watched{nullptr};
static_assert(std::atomic<Monitor*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

extern "C" void cancel_work(int) {
  if (Monitor* monitor = watched.load()) monitor->cancelled = true;
}

}  // namespace

InterruptHandler::InterruptHandler(Monitor& monitor)
    : monitor_(monitor), before_(watched.exchange(&monitor)) {
  struct sigaction once {};
  once.sa_handler = cancel_work;
  once.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &once, &old_interrupt_);
  sigaction(SIGTERM, &once, &old_terminate_);
}

InterruptHandler::~InterruptHandler() {
  watched = before_;
  if (before_ != nullptr && monitor_.cancelled) before_->cancelled = true;
  sigaction(SIGINT, &old_interrupt_, nullptr);
  sigaction(SIGTERM, &old_terminate_, nullptr);
}

}  // namespace opaline
