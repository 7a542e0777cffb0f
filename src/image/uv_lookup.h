// SPDX-License-Identifier: GPL-3.0-or-later
// From UVs to places of an image.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "image/texture_file.h"
#include "opaline/scene.h"

namespace opaline {

/// UVs count from the lower left corner, textures from the upper left one.
/// in    sides: of the filter's footprint, in UVs; on_whole_face: of a flat face with UVs from 0 to 1
inline TexturePlace uv_lookup(const Texture& texture, const std::array<float, 2>& uv,
                              const std::array<std::array<double, 2>, 2>& sides, bool on_whole_face = false) {
  const double angle = texture.uv_rotation * std::numbers::pi / 180;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const auto turned = [&](double u, double v) {
    const double x = u * texture.uv_scale[0], y = v * texture.uv_scale[1];
    return std::array<double, 2>{cosine * x + sine * y, cosine * y - sine * x};
  };
  const auto side = [&](const std::array<double, 2>& along) {
    const auto [u, v] = turned(along[0], -along[1]);
    return std::array<float, 2>{float(u), float(v)};
  };
  const bool maps_unchanged = texture.uv_offset == std::array<double, 2>{0, 0} &&
                              texture.uv_scale == std::array<double, 2>{1, 1} && texture.uv_rotation == 0;
  const auto [u, v] = turned(double(uv[0]), 1 - double(uv[1]));
  return {float(u + texture.uv_offset[0]), float(v + texture.uv_offset[1]), side(sides[0]), side(sides[1]),
          on_whole_face && maps_unchanged};
}

}  // namespace opaline
