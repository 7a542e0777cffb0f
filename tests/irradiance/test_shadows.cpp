// SPDX-License-Identifier: GPL-3.0-or-later
// Everything casts full shadows.
#include <gtest/gtest.h>

#include "support/lighting.h"

namespace opaline {
namespace {

using namespace test;

// Claim: a 4 x 4 lid at half height under a point light shades the 8 x 8 square below it exactly, whichever
// side of the lid is up, and nothing else. Source: similar triangles. Tolerance: none beyond a cell's reach,
// a spacing, inside the shadow's edge, and .01 mm outside of it. Fails if: shadow rays are not traced, run
// past the light, or cull back faces.
TEST(Shadows, OfALidAreSharp) {
  for (const bool up : {false, true}) {
    const Vec3d u{4, 0, 0}, v{0, 0, 4};
    const LitWorld scene(world_of({floor_quad(10), QuadShape{{-2, 5, -2}, up ? v : u, up ? u : v}}));
    const std::vector<std::uint32_t> floor_only = {0};
    const SurfaceSamples surface = sample_surface({scene.world, floor_only, 3000});
    const std::vector<SurfaceSample>& samples = surface.samples;
    const LightTransfer transfer = scene.transfer(samples, unit_point({0, 10, 0}), 1.5);
    std::size_t dark = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Vec3d p = scene.in_world(samples[i]);
      const double edge = std::max(std::abs(p.x), std::abs(p.z)) - 4;
      if (edge < -surface.spacing()) {
        ASSERT_EQ(transfer.weights[i], 0) << p.x << ' ' << p.z;
      }
      if (edge > .01) {
        ASSERT_GT(transfer.weights[i], 0) << p.x << ' ' << p.z;
      }
      const Vec3d to = Vec3d(0, 10, 0) - p;
      dark += double(transfer.weights[i]) < .5 * entering(normalized(to).y, 1.5) / dot(to, to);
    }
    EXPECT_NEAR(double(dark) / double(samples.size()), .16, .01);
  }
}

// Claim: a thing behind the light, seen from the sample, shades nothing; in front of it, all: point, sphere
// and quad lights. Source: geometry. Tolerance: none. Fails if: shadow rays have no end, or end short of the
// light.
TEST(Shadows, OnlyOfWhatIsBetween) {
  const QuadShape lid{{-50, 5, -50}, {100, 0, 0}, {0, 0, 100}};
  const LitWorld scene(world_of({floor_quad(4), lid}));
  const std::vector<std::uint32_t> floor_only = {0};
  const std::vector<SurfaceSample> samples = sample_surface({scene.world, floor_only, 50}).samples;
  for (const double y : {4.5, 5.5}) {
    for (const Light& light : {unit_point({0, y, 0}), unit_sphere_light({0, y, 0}, .4),
                               unit_quad_light({-1, y, -1}, {2, 0, 0}, {0, 0, 2})})
      for (const float weight : scene.transfer(samples, light, 1.5).weights) {
        if (y < 5) {
          ASSERT_GT(weight, 0);
        }
        if (y > 5) {
          ASSERT_EQ(weight, 0);
        }
      }
  }
  for (const Light& light : {unit_directional({0, -1, 0}), unit_directional({.5, -1, .2})})
    for (const float weight : scene.transfer(samples, light, 1.5).weights) ASSERT_EQ(weight, 0);
}

// Claim: a closed convex body does not shade its own lit side: no sample that faces the light by its
// geometric normal is dark, on a coarse box and on a fine torus's outer rim. Source: geometry. Tolerance:
// none from 1 degree above the horizon. Fails if: ray origins are not moved off the surface, or moved along
// the shading normal.
TEST(Shadows, NoAcne) {
  const Vec3d to = normalized(Vec3d(1, 2, 1.5));
  for (const ShapeSource& source :
       {ShapeSource(BoxShape{{-5, -5, -5}, {5, 5, 5}}), ShapeSource(SphereShape{{}, 10})}) {
    const LitWorld scene(world_of({source}));
    const std::vector<SurfaceSample> samples = samples_on(scene.world, 5000).samples;
    const LightTransfer transfer = scene.transfer(samples, unit_directional(-to), 1.3);
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (dot(scene.geometric(samples[i]), to) > .0175 && dot(Vec3d(samples[i].normal), to) > 0) {
        ASSERT_GT(transfer.weights[i], 0) << i;
      }
  }
}

}  // namespace
}  // namespace opaline
