// SPDX-License-Identifier: GPL-3.0-or-later
// Layers made by formula.
#pragma once

#include <cstddef>
#include <vector>

#include "opaline/compare.h"

namespace opaline {

/// width x height pixels, the value of channel c (R, G, B) at column x and row y being f(x, y, c).
template <class Formula>
Layer make_layer(int width, int height, const Formula& f) {
  Layer layer{width, height, {"R", "G", "B"}, {}};
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& plane = layer.channels.emplace_back();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) plane.push_back(static_cast<float>(f(x, y, c)));
  }
  return layer;
}

/// Every pixel shows an object.
inline std::vector<std::uint8_t> everywhere(const Layer& layer) {
  return std::vector<std::uint8_t>(layer.channels[0].size(), 1);
}

}  // namespace opaline
