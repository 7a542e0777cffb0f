// SPDX-License-Identifier: GPL-3.0-or-later
// Counter-based random numbers and low-discrepancy points: a value depends on its indices alone, independent
// of threads.
#pragma once

#include <array>
#include <cstdint>

namespace opaline {

/// 64 well-mixed bits of (seed, index): the finaliser of SplitMix64 (Steele et al. 2014) over a Weyl step.
constexpr std::uint64_t hash_bits(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t z = seed * 0xD1342543DE82EF95ull + (index + 1) * 0x9E3779B97F4A7C15ull;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

/// Uniform in [0, 1), 53 bits.
constexpr double unit_double(std::uint64_t bits) {
  return double(bits >> 11) * 0x1p-53;
}

/// Point i of the two-dimensional additive recurrence on the plastic number (R2, Roberts 2018), rotated by
/// `shift` (Cranley-Patterson), in [0, 1)^2.
constexpr std::array<double, 2> r2_point(std::uint64_t i, std::array<double, 2> shift) {
  constexpr double kInverse = 0.75487766624669276005, kInverseSquare = 0.56984029099805326591;
  const double u = shift[0] + kInverse * double(i), v = shift[1] + kInverseSquare * double(i);
  return {u - double(std::int64_t(u)), v - double(std::int64_t(v))};
}

/// The same in four dimensions, on the root of x^5 = x + 1.
constexpr std::array<double, 4> r4_point(std::uint64_t i, std::array<double, 4> shift) {
  constexpr std::array<double, 4> kSteps{0.85667488385450287, 0.73389185662064190, 0.62870672102576909,
                                         0.53859725722361136};
  for (std::size_t d = 0; d < 4; ++d) {
    shift[d] += kSteps[d] * double(i);
    shift[d] -= double(std::int64_t(shift[d]));
  }
  return shift;
}

}  // namespace opaline
