// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/formats/vertex_colors.h"

#include <algorithm>
#include <cmath>

#include "core/srgb.h"

namespace opaline {
namespace {

/// Clamped to [0, 1]; 0 for NaN.
float usable(float value) {
  return value > 0 ? std::min(value, 1.0f) : 0.0f;
}

bool is_whole(const RgbF& color) {
  return color == RgbF(std::floor(color.x), std::floor(color.y), std::floor(color.z));
}

bool exceeds_one(const RgbF& color) {
  return max_component(color) > 1;
}

}  // namespace

std::vector<RgbF> FileColors::linear(std::size_t elements) const {
  const bool counts_to_255 =
      std::ranges::any_of(colors_, exceeds_one) && std::ranges::all_of(colors_, is_whole);
  const float scale = counts_to_255 ? 1.0f / 255 : 1.0f;
  std::vector<RgbF> colors;
  colors.reserve(elements);
  for (const RgbF& color : colors_) {
    RgbF& linear = colors.emplace_back(1);
    for (std::size_t c = 0; c < 3 && color != kNone; ++c) {
      linear[c] = usable(color[c] * scale);
      if (counts_to_255 || coding_ == ColorCoding::srgb) linear[c] = float(srgb_to_linear(linear[c]));
    }
  }
  colors.resize(elements, RgbF(1));
  return colors;
}

void give_vertex_colors(SourceMesh& mesh, const std::vector<RgbF>& colors) {
  mesh.colors.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) mesh.colors.push_back({colors[a], colors[b], colors[c]});
}

}  // namespace opaline
