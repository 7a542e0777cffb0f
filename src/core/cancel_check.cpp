// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cancel_check.h"

#include <utility>

namespace opaline {
namespace {

thread_local Monitor* of_this_thread = nullptr;

}  // namespace

CancelScope::CancelScope(Monitor* monitor) : before_(std::exchange(of_this_thread, monitor)) {}

CancelScope::~CancelScope() {
  of_this_thread = before_;
}

CancelCheck::CancelCheck() : monitor_(of_this_thread) {}

}  // namespace opaline
