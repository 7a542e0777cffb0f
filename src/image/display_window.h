// SPDX-License-Identifier: GPL-3.0-or-later
// The display window of an image file, and the data window with its pixels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "opaline/error.h"

namespace opaline {

/// Pixels x to x + width of the rows y to y + height.
struct PixelWindow {
  int x = 0, y = 0, width = 0, height = 0;

  double pixels() const { return double(width) * height; }
  std::string text() const {
    return std::to_string(width) + " x " + std::to_string(height) + " at " + std::to_string(x) + "," +
           std::to_string(y);
  }
  friend bool operator==(const PixelWindow&, const PixelWindow&) = default;
};

/// Checks that the windows overlap, and that the display window's memory is in proportion to the data window.
/// error Error{bad_input} naming the file: no overlap; a display window with more than 64 times as many pixels, and more
///       than 4096 x 4096
inline void check_windows(const std::string& path, const PixelWindow& data, const PixelWindow& display) {
  if (data.x >= display.x + display.width || data.x + data.width <= display.x ||
      data.y >= display.y + display.height || data.y + data.height <= display.y)
    throw bad_file(path, "its data window lies outside of its display window", "within " + display.text(),
                   data.text());
  constexpr double kPadding = 64, kAlwaysAllowed = 4096. * 4096;
  const double most = std::max(kPadding * data.pixels(), kAlwaysAllowed);
  if (display.pixels() > most)
    throw bad_file(path, "its display window is too large for its data window",
                   "at most " + std::to_string(std::int64_t(most)) + " pixels",
                   std::to_string(std::int64_t(display.pixels())));
}

}  // namespace opaline
