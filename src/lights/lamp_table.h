// SPDX-License-Identifier: GPL-3.0-or-later
// Points and spots side by side, each weighed by what it could bring to a place.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "opaline/lights/light.h"

namespace opaline {

class LampTable {
 public:
  static constexpr std::size_t kBlock = 16;

  /// in    lights: points and spots; order: of the table
  LampTable(std::span<const Light> lights, std::span<const std::uint32_t> order);

  /// How many weights there are: the lamps' in their order, and zeros to the end of a block.
  std::size_t weights() const { return (x_.size() + kBlock - 1) / kBlock * kBlock; }
  /// Irradiance that nothing shadows, of each channel in units of that of all lamps, and a trace more wherever a rounding
  /// could make it 0.
  /// in    normal: unit; weights: weights() of them
  void weigh(const Vec3f& point, const Vec3f& normal, std::span<float> weights) const;

 private:
  template <bool has_spots>
  void weigh_block(const Vec3f& point, const Vec3f& normal, std::size_t first, float* weights) const;

  std::vector<float> x_, y_, z_, intensity_;
  /// Spots: the way they shine, the cosine at their rim, and the inverse of its difference to where they begin to fade;
  /// those of points are always beyond that.
  std::vector<float> way_x_, way_y_, way_z_, rim_, per_fade_;
  bool has_spots_ = false;
};

/// How often each of some weights is drawn: as it weighs, but no more than once.
class WeighedDraw {
 public:
  static constexpr std::size_t kMost = 4096, kBlock = LampTable::kBlock;

  /// in    weights: at most kMost, whole blocks, which must outlive it; draws: how many in all
  WeighedDraw(std::span<const float> weights, double draws);

  double expected(std::size_t i) const {
    return weights_[i] > 0 ? std::min(1.0, double(weights_[i]) * scale_) : 0;
  }
  /// Visits (index, expected, where it is drawn within it: [0, 1)) at random, random + 1, ... of the sum of all expected.
  template <class Visit>
  void visit(double random, std::size_t draws, const Visit& visit) const {
    std::size_t next = 0;
    double begin = 0;
    for (std::size_t b = 0; b < blocks_; ++b) {
      const double end = begin + block_length(b);
      if (next < draws && random + double(next) < end) {
        double at = begin;
        for (std::size_t i = b * kBlock; i < (b + 1) * kBlock; ++i) {
          const double length = expected(i);
          for (; next < draws && random + double(next) < at + length; ++next)
            visit(i, length, (random + double(next) - at) / length);
          at += length;
        }
        begin = at;
      } else {
        begin = end;
      }
    }
  }

 private:
  double block_length(std::size_t b) const;

  std::span<const float> weights_;
  double scale_ = 0;  // of weights, to how often each is drawn
  std::size_t blocks_;
  std::array<double, kMost / kBlock> sums_;
  std::array<float, kMost / kBlock> largest_;
};

}  // namespace opaline
