// SPDX-License-Identifier: GPL-3.0-or-later
// Detection of out-of-memory exceptions.
#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

namespace opaline {

/// Containers report impossible sizes as length_error, and threads without memory for a stack as EAGAIN.
inline bool is_out_of_memory(const std::exception& failure) {
  const auto* system = dynamic_cast<const std::system_error*>(&failure);
  return dynamic_cast<const std::bad_alloc*>(&failure) != nullptr ||
         dynamic_cast<const std::length_error*>(&failure) != nullptr ||
         (system != nullptr && system->code() == std::errc::resource_unavailable_try_again);
}

}  // namespace opaline
