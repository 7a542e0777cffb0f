// SPDX-License-Identifier: GPL-3.0-or-later
// Light that one body mirrors onto another.
#include <gtest/gtest.h>

#include <cmath>

#include "render/mirrored_light.h"
#include "support/scenes.h"

namespace opaline {
namespace {

using namespace test;

/// A lying slab of 20 x 20 mm, and one standing along its edge; light falls from the left at 45 degrees.
Scene slab_before_a_wall(Light light) {
  Scene scene = single_shape(BoxShape{{-20, -4, -10}, {0, 0, 10}}, marble(), 4000);
  scene.shapes[0].normals = NormalMode::faceted;
  scene.media.push_back(marble());
  scene.shapes.push_back(translucent("wall", BoxShape{{.01, -4, -10}, {4, 30, 10}}, 1));
  scene.shapes[1].normals = NormalMode::faceted;
  scene.settings.method = Method::volume_diffusion;
  scene.lights = {std::move(light)};
  return scene;
}

// Claim: the light of a lit face arrives where its mirror image falls: from a face at 45 degrees on a wall's lowest 20 mm,
// with the boundary's reflectance and the wall's transmittance, and nowhere above. Source: Fresnel's equations by hand, .0502
// reflected and .9498 transmitted at 45 degrees. Fails if: the cosine, a Fresnel factor, or the samples' area is missing,
// or light is mirrored about another normal.
TEST(MirroredLight, ArrivesAtTheImageOfTheLight) {
  const Prepared prepared(
      slab_before_a_wall({"sun", DirectionalLight{normalized(Vec3d{1, -1, 0}), {1, 2, 3}}}));
  const std::vector<std::vector<RgbF>> mirrored =
      mirrored_at_samples({prepared.scene, prepared.world, prepared.rays, prepared.plan}, prepared.bodies);
  ASSERT_EQ(mirrored.size(), 2u);
  const std::vector<SurfaceSample>& samples = prepared.bodies[1].surface.samples;
  ASSERT_EQ(mirrored[1].size(), samples.size());
  const double expected = std::sqrt(.5) * .0502 * .9498;  // in red, W/mm^2
  double low = 0, area = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3d at = out_of_world(prepared.world, Vec3d(samples[i].position));
    if (samples[i].normal.x < -.9f && at.y > 4 && at.y < 16 && std::abs(at.z) < 7) {
      low += double(mirrored[1][i].x) * double(samples[i].area);
      area += double(samples[i].area);
      EXPECT_NEAR(double(mirrored[1][i].z / mirrored[1][i].x), 3, 1e-3);
    }
    if (at.y > 24 || samples[i].normal.x > .9f) {
      EXPECT_EQ(mirrored[1][i], RgbF{});
    }
  }
  EXPECT_NEAR(low / area / expected, 1, .03);
}

// Claim: a light with an area mirrors as a point of the same flux does. Source: far away they are one. Fails if: the samples
// of a light with an area are weighted otherwise than a delta light's.
TEST(MirroredLight, OfASmallAreaIsThatOfAPoint) {
  const auto total = [](Light light) {
    const Prepared prepared(slab_before_a_wall(std::move(light)));
    const std::vector<std::vector<RgbF>> mirrored =
        mirrored_at_samples({prepared.scene, prepared.world, prepared.rays, prepared.plan}, prepared.bodies);
    double sum = 0;
    for (std::size_t i = 0; i < mirrored[1].size(); ++i)
      sum += double(mirrored[1][i].x) * double(prepared.bodies[1].surface.samples[i].area);
    return sum;
  };
  const Vec3d place{-500, 500, 0};
  const double by_point = total(point_light(place, Rgb(1e6)));
  EXPECT_GT(by_point, 0);
  // Radiant intensity: radiance times the area of the sphere's disc.
  EXPECT_NEAR(total({"sphere", SphereLight{place, 2, Rgb(1e6 / (kPi * 4))}}) / by_point, 1, .02);
}

}  // namespace
}  // namespace opaline
