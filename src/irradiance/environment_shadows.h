// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility of an environment from neighbouring points, estimated by their shadow rays.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "lights/environment_picture.h"

namespace opaline {

/// Visibility of each block of an environment map from neighbouring points. The points form two halves; the
/// rays of one half predict the visibility for the other, so a prediction is independent of its own rays.
class EnvironmentShadows {
 public:
  explicit EnvironmentShadows(const EnvironmentPicture& environment);

  /// A ray of a half towards a block.
  void add(std::size_t half, std::size_t block, bool is_lit) {
    Half& of = halves_[half];
    of.tried[block] += 1;
    of.lit[block] += is_lit ? 1 : 0;
  }
  /// Call after adding all rays; has_dark: per half, true if any of its rays was blocked.
  void estimate(const std::array<bool, 2>& has_dark);

  /// Visible fraction of a block for points of a half, in [0, 1].
  float open(std::size_t half, std::size_t block) const { return halves_[1 - half].open[block]; }
  /// Predicted irradiance of a surface of that half, as in EnvironmentPicture::unshadowed.
  /// in    normal: unit, in the image's space
  RgbF irradiance(std::size_t half, const Vec3d& normal);

 private:
  struct Half {
    std::vector<float> tried, lit, open;  // block by block
    std::vector<std::pair<std::size_t, EnvironmentPicture::Unshadowed>>
        known;  // by the environment's nearest tabulated normal
  };
  void spread(std::vector<float>& counts);

  const EnvironmentPicture& environment_;
  std::array<Half, 2> halves_;
  std::vector<float> spread_;
};

}  // namespace opaline
