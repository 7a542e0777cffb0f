// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "plan/make_plan.h"
#include "subsurface/light_distance.h"
#include "support/scenes.h"
#include "support/surfaces.h"

namespace opaline::test {
namespace {

// A box of 40 mm, far from zero, whose top is two triangles at y = 120; samples 1 mm apart.
Scene box_under(const LightSource& light) {
  Scene scene = single_shape(BoxShape{{80, 80, 80}, {120, 120, 120}}, marble(), 1);
  scene.settings.samples.reset();
  scene.settings.sample_spacing = 1;
  scene.lights = {{"lamp", light}};
  return scene;
}

std::vector<std::string> warnings_of_plan(const Scene& scene) {
  return make_plan(scene, make_world(scene)).warnings;
}

// Claim: a light nearer to a translucent surface than its samples are to each other is warned of, once, by
// name, with distance, on triangles far larger than the spacing; a wide one and one further off are not.
// Source: between samples nothing knows of a spot of light that is smaller. Fails when: distances are taken
// to vertices, or the light is not recentred.
TEST(NearLights, AreWarnedOf) {
  const Rgb white{1, 1, 1};
  const struct {
    LightSource light;
    std::string said;  // empty: nothing
  } cases[] = {
      {PointLight{{93, 120.5, 104}, white}, "shape: the light lamp is 0.5 mm from the surface"},
      {PointLight{{93, 119.75, 104}, white}, "the light lamp is 0.25 mm from"},
      {PointLight{{80.2, 120.3, 80.2}, white}, "the light lamp is 0.3 mm from"},
      {PointLight{{119.8, 120.3, 80.2}, white}, "the light lamp is 0.3 mm from"},
      {PointLight{{80.2, 120.3, 119.8}, white}, "the light lamp is 0.3 mm from"},
      {PointLight{{119.8, 120.3, 119.8}, white}, "the light lamp is 0.3 mm from"},
      {PointLight{{93, 121.5, 104}, white}, ""},
      {PointLight{{100, 100, 100}, white}, ""},
      {PointLight{{93, 120.5, 104}, {}}, ""},
      {SphereLight{{93, 120.5, 104}, .2, white}, "the light lamp is 0.5 mm from"},
      {SphereLight{{93, 120.5, 104}, 3, white}, ""},
      {QuadLight{{90, 120.5, 104}, {9, 0, 0}, {0, 0, .2}, white}, "the light lamp is 0.5 mm from"},
      {QuadLight{{90, 110, 104}, {0, 90, 0}, {.2, 0, 0}, white}, "the light lamp is 0 mm from"},
      {QuadLight{{90, 120.5, 104}, {9, 0, 0}, {0, 0, 9}, white}, ""},
      {DirectionalLight{{0, -1, 0}, white}, ""},
      {Surroundings{white}, ""},
  };
  for (const auto& c : cases) {
    const std::vector<std::string> warnings = warnings_of_plan(box_under(c.light));
    ASSERT_EQ(warnings.size(), c.said.empty() ? 0u : 1u) << (warnings.empty() ? c.said : warnings[0]);
    if (warnings.empty()) continue;
    EXPECT_NE(warnings[0].find(c.said), std::string::npos) << warnings[0];
    EXPECT_EQ(warnings[0].find('\n'), std::string::npos);
  }
}

// Claim: what has no samples is near to no light: opaque shapes, and the Lambert method. Fails when: all
// meshes are asked.
TEST(NearLights, OnlyWhereSamplesAre) {
  Scene scene = box_under(PointLight{{93, 120.5, 104}, {1, 1, 1}});
  scene.settings.method = Method::lambert;
  EXPECT_TRUE(warnings_of_plan(scene).empty());
  scene.settings.method = Method::hierarchical;
  EXPECT_EQ(warnings_of_plan(scene).size(), 1u);
  scene.shapes[0].medium.reset();
  EXPECT_TRUE(warnings_of_plan(scene).empty());
}

double brute_distance(const std::vector<Piece>& pieces, const Vec3d& start, const Vec3d& along, int steps) {
  double least = INFINITY;
  for (int i = 0; i <= steps; ++i) {
    const Vec3d p = start + along * (double(i) / steps);
    for (const Piece& piece : pieces) least = std::min(least, length(piece.position - p));
  }
  return least;
}

// Claim: the distance is that from a dense cloud on the surface, which is larger by at most a piece's size,
// wherever the light is. Source: the cloud. Fails when: the ball around a triangle is too small, or the
// search along a tube stops short.
TEST(NearLights, DistanceAsFromADenseCloud) {
  const World world = world_of({TorusShape{{}, 20, 6}});
  const std::vector<Piece> pieces = dense_pieces(world, .05);
  const std::vector<std::uint32_t> meshes{0};
  const double size = .5;  // pieces are no slivers: the tessellation is even
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-30, 30), tilt(-20, 20);
  for (int i = 0; i < 20; ++i) {
    const Vec3d start{place(random), place(random) / 3, place(random)};
    const Vec3d along{tilt(random), tilt(random), tilt(random)};
    const auto point = near_light_distance({"", PointLight{start, {}}}, world, meshes, 1e3);
    ASSERT_TRUE(point);
    const double expected = brute_distance(pieces, start, {}, 1);
    EXPECT_LE(*point, expected + 1e-9);
    EXPECT_GE(*point, expected - size);
    const Vec3d across = normalized(cross(along, Vec3d{0, 1, 0})) * 1e-6;
    const auto tube = near_light_distance({"", QuadLight{start, across, along, {}}}, world, meshes, 1e3);
    ASSERT_TRUE(tube);
    const double of_tube = brute_distance(pieces, start, along, 50);
    EXPECT_LE(*tube, of_tube + 1e-5);
    EXPECT_GE(*tube, of_tube - size - .4);
    EXPECT_FALSE(near_light_distance({"", PointLight{start, {}}}, world, meshes, .999 * *point));
  }
}

}  // namespace
}  // namespace opaline::test
