// SPDX-License-Identifier: GPL-3.0-or-later
// Scrambled points of the Sobol sequence.
#include <gtest/gtest.h>

#include <set>

#include "core/scrambled_points.h"

namespace opaline {
namespace {

// Claim: the first 2^k points, and the 2^k after them, have one point in each of the 2^k boxes of any shape 2^-a x 2^(a - k), by
// every key. Source: (0, 2)-sequences; Owen scrambling keeps the property. Tolerance: none. Fails if: a direction number, the
// order of bits or the permutation of numbers is wrong.
TEST(ScrambledPoints, HalvesCoverEveryShapeOfBox) {
  for (std::uint64_t key = 0; key < 8; ++key)
    for (std::uint32_t k = 0; k <= 8; ++k)
      for (std::uint32_t a = 0; a <= k; ++a)
        for (const std::uint32_t first : {0u, 1u << k}) {
          std::set<std::array<int, 2>> boxes;
          for (std::uint32_t i = first; i < first + (1u << k); ++i) {
            const auto [u, v] = scrambled_point(i, key);
            boxes.insert({int(u * (1 << a)), int(v * (1 << (k - a)))});
          }
          EXPECT_EQ(boxes.size(), std::size_t(1) << k) << key << ' ' << k << ' ' << a << ' ' << first;
        }
}

// Claim: points of different keys are uniform and independent: over 4,096 keys, the means of a point, of its squares and of the
// product of two keys' points are those of uniform numbers. Tolerance: 5 standard errors. Fails if: a coordinate
// is not scrambled, or by the same bits for all keys.
TEST(ScrambledPoints, KeysAreIndependent) {
  constexpr int kKeys = 4096;
  double u = 0, v = 0, uu = 0, uv = 0, next = 0;
  for (std::uint64_t key = 0; key < kKeys; ++key) {
    const std::array<double, 2> point = scrambled_point(5, key), other = scrambled_point(5, key + 1);
    u += point[0] / kKeys;
    v += point[1] / kKeys;
    uu += point[0] * point[0] / kKeys;
    uv += point[0] * point[1] / kKeys;
    next += point[0] * other[0] / kKeys;
  }
  EXPECT_NEAR(u, .5, 5 * .289 / 64);
  EXPECT_NEAR(v, .5, 5 * .289 / 64);
  EXPECT_NEAR(uu, 1. / 3, 5 * .298 / 64);
  EXPECT_NEAR(uv, .25, 5 * .22 / 64);
  EXPECT_NEAR(next, .25, 5 * .22 / 64);
}

}  // namespace
}  // namespace opaline
