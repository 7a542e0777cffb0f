// SPDX-License-Identifier: GPL-3.0-or-later
// Limit for empty pixels requested by a file's header alone.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "opaline/error.h"

namespace opaline {

/// Checks that the memory of a display window is in proportion to the data window.
/// in    data, display: pixels
/// error Error{bad_input} naming the file: more than 64 times as many pixels, and more than 4096 x 4096
inline void check_display_window(const std::string& path, double data, double display) {
  constexpr double kPadding = 64, kAlwaysAllowed = 4096. * 4096;
  const double most = std::max(kPadding * data, kAlwaysAllowed);
  if (display > most)
    throw bad_file(path, "its display window is too large for its data window",
                   "at most " + std::to_string(std::int64_t(most)) + " pixels",
                   std::to_string(std::int64_t(display)));
}

}  // namespace opaline
