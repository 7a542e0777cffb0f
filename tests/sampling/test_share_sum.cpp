// SPDX-License-Identifier: GPL-3.0-or-later
// The samples' shares add up to the surface.
#include <gtest/gtest.h>

#include "support/surfaces.h"

namespace opaline {
namespace {

using namespace test;

// Claim: the shares of area sum to the mesh area, whatever the shape and the count; none is zero, negative or
// not finite. Source: the contract of sample_surface.h; a fixed area a sample covered 48 % of the mesh in a
// published implementation. Tolerance: 1e-6 of the area, the contract's; float shares round by 6e-8. Fails
// if: shares are left as counts of candidates without normalisation, or one clipped piece is lost.
TEST(ShareSum, IsTheMeshArea) {
  for (const auto& [name, world] : table_of_worlds())
    for (const std::size_t count : {10u, 300u, 6000u}) {
      SCOPED_TRACE(name + ", " + std::to_string(count) + " samples");
      const SurfaceSamples surface = samples_on(world, count);
      const double area = surface_area(world.meshes[0]);
      EXPECT_NEAR(surface.area / area, 1, 1e-9);
      EXPECT_NEAR(sum_of_shares(surface) / area, 1, 1e-6);
      for (const SurfaceSample& s : surface.samples)
        ASSERT_TRUE(std::isfinite(s.area) && s.area > 0) << s.area;
    }
}

// Claim: sphere 4 pi R^2, torus 4 pi^2 R r and box areas come out, so shares are in mm^2. Source: geometry.
// Tolerance: 1e-3, what make_mesh promises of built-in shapes; 1e-6 for the box. Fails if: shares are
// normalised to 1 or to anything but the surface.
TEST(ShareSum, IsInSquareMillimetres) {
  using std::numbers::pi;
  EXPECT_NEAR(sum_of_shares(samples_on(world_of({SphereShape{{}, 25}}), 500)) / (4 * pi * 625), 1, 1e-3);
  EXPECT_NEAR(sum_of_shares(samples_on(world_of({TorusShape{{}, 20, 6}}), 500)) / (4 * pi * pi * 120), 1,
              1e-3);
  EXPECT_NEAR(sum_of_shares(samples_on(world_of({BoxShape{{0, 0, 0}, {1, 2, 3}}}), 500)) / 22, 1, 1e-6);
}

}  // namespace
}  // namespace opaline
