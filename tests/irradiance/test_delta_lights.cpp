// SPDX-License-Identifier: GPL-3.0-or-later
// Point and directional lights: no integral, so formulas hold sample by sample.
#include <gtest/gtest.h>

#include "support/lighting.h"

namespace opaline {
namespace {

using namespace test;

// Claim: a point light of intensity I over a sphere gives E = I / d^2 x cos x Ft at every sample that faces
// it, 0 at every other, and states no error. Source: the energy convention of scene.h, Fresnel by sine and
// tangent laws. Tolerance: 1e-4 relative, float rounding at cos >= .02. Fails if: Ft is left out, taken at
// normal incidence or averaged; d for d^2; the geometric normal for the shading one.
TEST(DeltaLights, PointLightOverASphere) {
  const LitWorld scene(world_of({SphereShape{{1, 2, 3}, 10}}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 2000).samples;
  const Vec3d position{8, 30, -7};
  for (const double eta : {1., 1.3, 1.5, .75, 3.9}) {
    SCOPED_TRACE(eta);
    const LightTransfer transfer = scene.transfer(samples, unit_point(position), eta);
    EXPECT_EQ(transfer.relative_error, 0);
    std::size_t lit = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Vec3d to = position - scene.in_world(samples[i]);
      const double cosine = dot(normalized(to), Vec3d(samples[i].normal));
      const double side = dot(normalized(to), scene.geometric(samples[i])),
                   weight = double(transfer.weights[i]);
      if (side < -1e-3) {
        ASSERT_EQ(weight, 0);
      }
      if (side < 1e-2 || cosine < .02) continue;
      ++lit;
      const double expected = entering(cosine, eta) / dot(to, to);
      ASSERT_NEAR(weight, expected, 1e-4 * expected) << "cosine " << cosine;
    }
    EXPECT_GT(lit, samples.size() / 4);
  }
}

// Claim: a directional light of irradiance 1 gives cos x Ft by the angle of each direction, from normal to
// grazing, for any eta; exactly 0 beyond the critical angle of eta < 1. Source: as above. Tolerance: 1e-4
// relative. Fails if: one transmittance serves all directions: at 89 degrees Ft is .1, its average .91.
TEST(DeltaLights, FtIsPerDirection) {
  const LitWorld scene(world_of({floor_quad(5)}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 5).samples;
  for (const double eta : {1., 1.3, 1.5, .75, 3.9})
    for (const double degrees : {0., 20., 45., 60., 80., 85., 89.}) {
      const double angle = degrees * pi / 180, expected = entering(std::cos(angle), eta);
      const Light light = unit_directional({-std::sin(angle), -std::cos(angle), 0});
      for (const float weight : scene.transfer(samples, light, eta).weights)
        EXPECT_NEAR(double(weight), expected, 1e-4 * expected)
            << "eta " << eta << ", " << degrees << " degrees";
    }
}

// Claim: where the shading normal leans 55 degrees away from the geometric one, light must be above both
// planes: the side is the geometric normal's, cosine and Ft the shading normal's. Source: irradiance.h.
// Tolerance: 1e-4 relative, none for 0. Fails if: the geometric side is not asked (at a triangle's corner no
// shadow ray meets the triangle itself), or the cosine is geometric.
TEST(DeltaLights, MustBeAboveBothPlanes) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals.assign(3, normalized(Vec3f(-1, 1, -1)));
  const LitWorld scene(world_of_mesh(mesh));
  const std::vector<SurfaceSample> corner = {sample_at(scene.world, 0, 0, 0, 0)};
  const auto weight = [&](const Vec3d& to) {
    return double(scene.transfer(corner, unit_directional(-to), 1.5).weights[0]);
  };
  EXPECT_EQ(weight({-1, -.1, -1}), 0);  // below the triangle, above the shading normal's plane
  EXPECT_EQ(weight({2, .1, 2}), 0);     // the other way round
  const double cosine = dot(normalized(Vec3d(-1, .5, 0)), normalized(Vec3d(-1, 1, -1)));
  EXPECT_NEAR(weight({-1, .5, 0}), entering(cosine, 1.5), 1e-4 * entering(cosine, 1.5));
}

// Claim: E falls with 1 / d^2 from 1 mm to a kilometre. Source: geometry. Tolerance: 1e-4 relative. Fails if:
// distances are clamped, or lost in floats.
TEST(DeltaLights, InverseSquare) {
  const LitWorld scene(world_of({floor_quad(5)}));
  const std::vector<SurfaceSample> samples = {sample_at(scene.world, 0, 0, .3f, .3f)};
  for (const double d : {1., 10., 1e3, 1e6}) {
    const Light light = unit_point(scene.in_world(samples[0]) + Vec3d(0, d, 0));
    EXPECT_NEAR(double(scene.transfer(samples, light, 1).weights[0]) * d * d, 1, 1e-4) << d;
  }
}

}  // namespace
}  // namespace opaline
