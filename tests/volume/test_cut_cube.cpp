// SPDX-License-Identifier: GPL-3.0-or-later
// What a plane leaves of a cell and of its faces.
#include <gtest/gtest.h>

#include <cmath>

#include "volume/cut_cube.h"

namespace opaline {
namespace {

constexpr int kSteps = 80;  // points along an axis

double middle_of_step(int i) {
  return (i + .5) / kSteps - .5;
}

// Normals along an axis, along a face's diagonal, of either sign, and nearly along an axis.
const std::array<Vec3d, 6> kNormals{normalized(Vec3d(0, 1, 0)),     normalized(Vec3d(0, 0, -1)),
                                    normalized(Vec3d(1, -1, 0)),    normalized(Vec3d(.3, -.5, .7)),
                                    normalized(Vec3d(-1, .002, 0)), normalized(Vec3d(1, 1, 1))};
constexpr std::array<double, 5> kHeights{-.6, -.31, 0, .17, .55};

// Claim: volume and centre of what lies behind a plane. Source: counting points. Tolerance: .01, of 80^3 points and of
// components under .001. Fails if: a corner is left out, or normals of the other sign are not mirrored.
TEST(CutCube, PartBehindPlaneAsCounted) {
  for (const Vec3d& normal : kNormals)
    for (const double height : kHeights) {
      std::size_t count = 0;
      Vec3d sum{};
      for (int k = 0; k < kSteps; ++k)
        for (int j = 0; j < kSteps; ++j)
          for (int i = 0; i < kSteps; ++i) {
            const Vec3d p(middle_of_step(i), middle_of_step(j), middle_of_step(k));
            if (dot(p, normal) > height) continue;
            ++count;
            sum += p;
          }
      const PartOfCube part = part_behind(normal, height);
      EXPECT_NEAR(part.volume, double(count) / (kSteps * kSteps * kSteps), .01);
      if (part.volume < .02) continue;  // few points
      const Vec3d centre = sum / double(count);
      for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(part.centre[axis], centre[axis], .01);
    }
}

// Claim: a face's share behind a line, and 0 or 1 where the line passes it by. Source: counting points. Tolerance: .01.
// Fails if: the normal's length, which is not 1 on a face, is divided out.
TEST(CutCube, ShareBehindLineAsCounted) {
  for (const Vec3d& normal : kNormals)
    for (const double height : kHeights) {
      int count = 0;
      for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < kSteps; ++i)
          count += middle_of_step(i) * normal.x + middle_of_step(j) * normal.y <= height;
      const bool is_along = std::hypot(normal.x, normal.y) < 1e-9;  // of the face
      EXPECT_NEAR(share_behind({normal.x, normal.y}, height), double(count) / (kSteps * kSteps),
                  is_along && height == 0 ? .5 : .01);
    }
}

}  // namespace
}  // namespace opaline
