// SPDX-License-Identifier: GPL-3.0-or-later
// Linear colours from one RGB space to another.
#include <gtest/gtest.h>

#include <cmath>

#include "core/rgb_primaries.h"

namespace opaline {
namespace {

// Claim: Rec.709 to ACEScg is the matrix that the ACES and OpenColorIO configurations have, to five digits.
// Source: OpenColorIO-Config-ACES, "Linear Rec.709 (sRGB)" to ACEScg. Fails if whites are not adapted (rows then sum to
// other than 1), or by another method than Bradford's (.0005 off). Tolerance: theirs starts from a matrix of Rec.709 that
// is rounded to four digits, 1e-5.
TEST(RgbPrimaries, Rec709ToAcescg) {
  const ColorMatrix published{
      {{.613097, .339523, .047379}, {.070194, .916354, .013452}, {.020616, .109570, .869815}}};
  const ColorMatrix matrix = color_matrix(kRec709Primaries, kAp1Primaries);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      EXPECT_NEAR(matrix[row][column], published[row][column], 1e-5) << row << ' ' << column;
}

// Claim: white stays white, and there and back is the same colour. Tolerance: double rounding. Fails if the inverse or
// the order of products is wrong.
TEST(RgbPrimaries, WhiteAndBack) {
  const ColorMatrix there = color_matrix(kRec709Primaries, kAp1Primaries),
                    back = color_matrix(kAp1Primaries, kRec709Primaries);
  for (const Vec3d& color : {Vec3d{1, 1, 1}, Vec3d{.2, .7, .05}, Vec3d{40, 0, 3}}) {
    const Vec3d returned = back * (there * color);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(returned[c], color[c], 1e-12 * max_component(color));
  }
  const Vec3d white = there * Vec3d(1);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 1e-13);
}

}  // namespace
}  // namespace opaline
