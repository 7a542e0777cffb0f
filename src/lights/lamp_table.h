// SPDX-License-Identifier: GPL-3.0-or-later
// Point and spot lights, weighted by unoccluded irradiance at a point.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lights/light.h"

namespace opaline {

class LampTable {
 public:
  static constexpr std::size_t kBlock = 16;

  /// in    lights: points and spots; order: of the table; colours: one per light, of its irradiance
  LampTable(std::span<const Light> lights, std::span<const std::uint32_t> order,
            std::span<const RgbF> colours);

  /// Number of weights: the lights' in their order, and zeros to the end of a block.
  std::size_t weights() const { return (x_.size() + kBlock - 1) / kBlock * kBlock; }
  /// Unoccluded irradiance in units of the lights' brightness, with a small offset to avoid zeros from
  /// rounding.
  /// in    normal: unit; weights: weights() of them
  void weigh(const Vec3f& point, const Vec3f& normal, std::span<float> weights) const;
  /// Irradiance of a light with that weight, in its colour.
  RgbF brought(std::size_t lamp, float weight) const {
    return RgbF{colours_[0][lamp], colours_[1][lamp], colours_[2][lamp]} * weight;
  }
  /// Sum over a block's lights.
  RgbF brought_by_block(std::size_t block, std::span<const float> weights) const;

 private:
  template <bool has_spots>
  void weigh_block(const Vec3f& point, const Vec3f& normal, std::size_t first, float* weights) const;

  std::vector<float> x_, y_, z_, intensity_;
  std::array<std::vector<float>, 3> colours_;  ///< over the brightness used by `weigh`
  /// Spots: axis, cosine at the rim, and inverse width of the falloff in the cosine; trivial for points.
  std::vector<float> way_x_, way_y_, way_z_, rim_, per_fade_;
  bool has_spots_ = false;
};

/// Expected samples of each light: proportional to its weight, but at most one.
class WeighedDraw {
 public:
  static constexpr std::size_t kMost = 4096, kBlock = LampTable::kBlock;

  /// in    weights: of the lights, at most kMost; both must outlive the object; draws: total number
  WeighedDraw(const LampTable& lamps, std::span<const float> weights, double draws);

  double expected(std::size_t i) const {
    if (!(weights_[i] > 0)) return 0;
    return is_sure(weights_[i]) ? 1 : double(weights_[i]) * scale_;
  }

  /// One sample among lights side by side, with lengths equal to their expected samples.
  struct Stratum {
    double place = 0;  ///< sampled position, in [0, 1)
    std::size_t lamp = 0;
    float expected = 0;  ///< expected samples of the light over all strata; 0: nothing was sampled
    RgbF brought{};      ///< mean contribution without occlusion (LampTable::brought)
  };
  /// Gives a stratum to each light with one expected sample. Returns their number.
  std::size_t take_sure(std::span<Stratum> strata) const;
  /// The other lights, in strata of equal length.
  void take_others(std::span<Stratum> strata) const;

 private:
  class OtherLamps;

  // Tolerates rounding: a light of almost one expected sample, split over two strata, could be sampled twice
  // or never.
  bool is_sure(float weight) const { return double(weight) * scale_ >= 1 - 1e-9; }
  double length_of_others(std::size_t block) const;

  const LampTable& lamps_;
  std::span<const float> weights_;
  double scale_ = 0;  // expected samples over weight
  std::size_t blocks_;
  std::array<double, kMost / kBlock> sums_;
  std::array<float, kMost / kBlock> largest_;
};

}  // namespace opaline
