// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers of one walk.
#pragma once

#include <array>
#include <cstdint>

#include "core/random.h"

namespace opaline {

/// A stream depending only on the seed and the walk's index: walks may run in any order on any thread.
class WalkNumbers {
 public:
  WalkNumbers(std::uint64_t seed, std::uint64_t walk) : key_(hash_bits(seed, walk)) {}

  /// Uniform in [0, 1).
  double next() { return unit_double(hash_bits(key_, count_++)); }

  /// Two numbers, uniform in [-1, 1), 32 bits each.
  std::array<double, 2> next_pair() {
    const std::uint64_t bits = hash_bits(key_, count_++);
    return {double(std::int32_t(bits >> 32)) * 0x1p-31, double(std::int32_t(bits)) * 0x1p-31};
  }

  /// Cosine and sine of a uniform angle: a point of the unit disc, its angle doubled.
  std::array<double, 2> next_angle() {
    for (;;) {
      const double x = 2 * next() - 1, y = 2 * next() - 1, square = x * x + y * y;
      if (square <= 1 && square > 1e-30) return {(x * x - y * y) / square, 2 * x * y / square};
    }
  }

 private:
  std::uint64_t key_, count_ = 0;
};

}  // namespace opaline
