// SPDX-License-Identifier: GPL-3.0-or-later
// Points and spots side by side, each weighed by what it could bring to a place.
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

  /// in    lights: points and spots; order: of the table; colours: one a light, of what it brings
  LampTable(std::span<const Light> lights, std::span<const std::uint32_t> order,
            std::span<const RgbF> colours);

  /// How many weights there are: the lamps' in their order, and zeros to the end of a block.
  std::size_t weights() const { return (x_.size() + kBlock - 1) / kBlock * kBlock; }
  /// Irradiance that nothing shadows, of each channel in units of that of all lamps, and a trace more wherever a rounding
  /// could make it 0.
  /// in    normal: unit; weights: weights() of them
  void weigh(const Vec3f& point, const Vec3f& normal, std::span<float> weights) const;
  /// Contribution of a light with that weight, in its colour.
  RgbF brought(std::size_t lamp, float weight) const {
    return RgbF{colours_[0][lamp], colours_[1][lamp], colours_[2][lamp]} * weight;
  }
  /// The same of a block's lamps together.
  RgbF brought_by_block(std::size_t block, std::span<const float> weights) const;

 private:
  template <bool has_spots>
  void weigh_block(const Vec3f& point, const Vec3f& normal, std::size_t first, float* weights) const;

  std::vector<float> x_, y_, z_, intensity_;
  std::array<std::vector<float>, 3> colours_;  ///< over what `weigh` takes for their brightness
  /// Spots: the way they shine, the cosine at their rim, and the inverse of its difference to where they begin to fade;
  /// those of points are always beyond that.
  std::vector<float> way_x_, way_y_, way_z_, rim_, per_fade_;
  bool has_spots_ = false;
};

/// How often each of some lamps is drawn: as it weighs, but no more than once.
class WeighedDraw {
 public:
  static constexpr std::size_t kMost = 4096, kBlock = LampTable::kBlock;

  /// in    weights: of the lamps, at most kMost; both must outlive it; draws: how many in all
  WeighedDraw(const LampTable& lamps, std::span<const float> weights, double draws);

  double expected(std::size_t i) const {
    if (!(weights_[i] > 0)) return 0;
    return is_sure(weights_[i]) ? 1 : double(weights_[i]) * scale_;
  }

  /// One draw among lamps lying side by side, each as long as it is expected.
  struct Stratum {
    double place = 0;  ///< where it is drawn, in [0, 1)
    std::size_t lamp = 0;
    float expected = 0;  ///< how often it takes the lamp from all strata; 0: nothing was drawn
    RgbF brought{};      ///< mean contribution without occlusion (LampTable::brought)
  };
  /// Gives a stratum to each lamp expected once. Returns how many these are.
  std::size_t take_sure(std::span<Stratum> strata) const;
  /// The other lamps, in strata of one length.
  void take_others(std::span<Stratum> strata) const;

 private:
  class OtherLamps;

  // But for rounding: a lamp that was drawn nearly always would be drawn twice or never in two strata.
  bool is_sure(float weight) const { return double(weight) * scale_ >= 1 - 1e-9; }
  double length_of_others(std::size_t block) const;

  const LampTable& lamps_;
  std::span<const float> weights_;
  double scale_ = 0;  // scale of weights, to how often each is drawn
  std::size_t blocks_;
  std::array<double, kMost / kBlock> sums_;
  std::array<float, kMost / kBlock> largest_;
};

}  // namespace opaline
