// SPDX-License-Identifier: GPL-3.0-or-later
// Control variates of walks in a slab: sums of mean 0 correlated with the exiting light.
#pragma once

#include <array>
#include <cstddef>

#include "transport/random_walk.h"

namespace opaline {

/// For each of a family of functions f(depth, upward cosine), the sum over a walk's flights of weight (f
/// before the flight - mean of weight f after it), less f at the start: its mean is 0 for any f
/// (src/transport/README.md). The family: exp(rate depth) times a Legendre polynomial of the cosine, with
/// closed-form means. One more is the weight at the start less 1.
class SlabControls {
 public:
  static constexpr std::size_t kRates = 5, kOrders = 6, kCount = kRates * kOrders + 1;
  using Sums = std::array<double, kCount>;

  /// thickness in mm, may be infinite; the faces are at z = 0 and z = -thickness.
  SlabControls(const HomogeneousMedium& medium, double thickness);

  /// Subtracts f at the start; call also for walks of zero weight.
  void start(const WalkState& walk, Sums& sums) const {
    add(walk, -walk.weight, sums);
    sums.back() += walk.weight - 1;
  }
  /// Before each flight.
  void visit(const WalkState& walk, const Crossing& crossing, Sums& sums) const;
  /// At the end of an unfinished walk.
  void give_up(const WalkState& walk, Sums& sums) const { add(walk, walk.weight, sums); }

 private:
  using Exponentials = std::array<double, kRates>;
  Exponentials exponentials(double depth) const;
  void add(const WalkState& walk, double weight, Sums& sums) const;

  HomogeneousMedium medium_;
  bool is_half_space_;
  double optical_thickness_;
  std::size_t rates_used_;                 ///< a half space has no far face
  std::array<double, kRates> rates_{};     ///< 1/mean free path; all below 1
  std::array<double, kOrders> damping_{};  ///< g^order
  Exponentials near_{}, far_{};            ///< at the faces
};

}  // namespace opaline
