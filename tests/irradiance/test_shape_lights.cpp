// SPDX-License-Identifier: GPL-3.0-or-later
// Light of emitting shapes at points.
#include <gtest/gtest.h>

#include "bodies/body.h"
#include "core/random.h"
#include "core/scratch_folder.h"
#include "support/lighting.h"
#include "support/pictures.h"
#include "support/scenes.h"

namespace opaline {
namespace {

using namespace test;

/// A quad over [-1, 1]^2 at y = 1 that faces down, with this emission.
std::string emitting_panel(const std::string& emission) {
  return R"({"shapes": [{"name": "panel", "quad": {"corner": [-1, 1, -1], "u": [2, 0, 0], "v": [0, 0, 2]},
    "emission": )" +
         emission + "}]}";
}

struct EmittingScene {
  Scene scene;
  World world;
  std::vector<Light> lights;
  explicit EmittingScene(Scene s)
      : scene(std::move(s)), world(make_world(scene)), lights(recentred_lights(scene, world)) {}
  Vec3f point(const Vec3d& p) const { return Vec3f(into_world(world, p)); }
  /// Unshadowed, of all lights, by n samples.
  RgbF irradiance(const Vec3d& at, const Vec3f& normal, int n) const {
    Rgb sum;
    for (const Light& light : lights)
      for (int i = 0; i < n; ++i) {
        const LightSample s = sample_light(light, point(at), normal, r2_point(std::uint64_t(i), {.5, .5}), n);
        sum += emission(light) * double(s.weight * std::max(0.f, dot(s.direction, normal)));
      }
    return RgbF(sum);
  }
};

// Claim: the samples of an emitting shape sum to the solid angle that its outer side fills, 2 pi / 3 for the face of a cube
// from its middle and 0 from behind; a sphere's to its cone. Source: geometry. Tolerance: 2e-3 and 5e-3, the rule. Fails if: the density is not that of the samples, or both sides emit.
TEST(ShapeLights, WeightsSumToTheSolidAngle) {
  const auto solid_angle = [](const EmittingScene& lit, const Vec3d& at) {
    double sum = 0;
    const int n = 40000;
    for (int i = 0; i < n; ++i)
      sum += double(
          sample_light(lit.lights.at(0), lit.point(at), {0, 1, 0}, r2_point(std::uint64_t(i), {.5, .5}), n)
              .weight);
    return sum;
  };
  const EmittingScene panel(parse_scene(emitting_panel("1"), "a.json"));
  ASSERT_EQ(panel.lights.size(), 1u);
  EXPECT_NEAR(solid_angle(panel, {0, 0, 0}), 2 * pi / 3, 2e-3 * 2 * pi / 3);
  EXPECT_EQ(solid_angle(panel, {0, 3, 0}), 0);
  const EmittingScene ball(parse_scene(
      R"({"shapes": [{"sphere": {"center": [0, 3, 0], "radius": 2}, "emission": 1}]})", "a.json"));
  const double cone = 2 * pi * (1 - std::sqrt(1 - 4. / 9));
  EXPECT_NEAR(solid_angle(ball, {0, 0, 0}), cone, 5e-3 * cone);
}

// Claim: a textured emission lights each channel by the sum of texel x cosines / distance^2 over the panel, here of a bright
// texel, one darker by 1,000 and others. Source: brute force over 200 x 200 points. Tolerance: 0.5 %, the rules.
// Fails if: samples are weighted by the mean texel, u and v are exchanged, or dark cells are never sampled.
TEST(ShapeLights, TexturesLightAsTheirSum) {
  const ScratchFolder folder;
  const auto texel = [](int x, int y) {
    const double value = x == 1 && y == 2 ? 40 : .04;
    return std::array<double, 3>{value, .1 + x, y == 0 ? 3. : 0.};
  };
  // Each texel is 16 x 16 pixels, so that interpolation between them hardly matters.
  put_exr(folder.file("a.exr"), 64, 64, [&](int x, int y) { return texel(x / 16, y / 16); });
  const EmittingScene lit(
      parse_scene(emitting_panel(R"({"texture": "a.exr", "scale": 0.5})"), folder.file("a.json")));
  ASSERT_EQ(lit.lights.size(), 3u);
  const Vec3d at{.3, 0, -.2};
  const int n = 200;
  Rgb sum;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = (i + .5) / n, v = (j + .5) / n;
      const Vec3d to = Vec3d{-1 + 2 * u, 1, -1 + 2 * v} - at;
      const std::array<double, 3> value = texel(int(4 * u), int(4 * (1 - v)));
      const double share = .5 * to.y * to.y / std::pow(dot(to, to), 2) * 4 / n / n;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += value[c] * share;
    }
  const RgbF irradiance = lit.irradiance(at, {0, 1, 0}, 40000);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(double(irradiance[c]), sum[c], 5e-3 * sum[c]) << c;
}

// Claim: the density of a sampled direction is that of the sample: density x weight x samples is the texel; the bright
// quarter of a panel receives its part of the samples. Source: light.h. Tolerance: 1e-3. Fails if: the density is that of
// uniform points, or of the back.
TEST(ShapeLights, DensityIsThatOfSamples) {
  const ScratchFolder folder;
  put_exr(folder.file("a.exr"), 64, 64, [](int x, int y) {
    return std::array<double, 3>(x < 32 && y < 32 ? std::array{9., 9., 9.} : std::array{1., 1., 1.});
  });
  const EmittingScene lit(parse_scene(emitting_panel(R"({"texture": "a.exr"})"), folder.file("a.json")));
  const Vec3f point = lit.point({.1, 0, .2}), normal{0, 1, 0};
  const Light& light = lit.lights.at(0);
  int bright = 0;
  const int n = 50;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const LightSample s = sample_light(light, point, normal, {(i + .5) / n, (j + .5) / n}, n * n);
      const float density = sampling_density(light, point, normal, s.direction);
      const EmitterHit hit =
          intersect_emitter(light, point, s.direction, std::numeric_limits<float>::infinity());
      ASSERT_TRUE(hit.hit);
      EXPECT_NEAR(hit.t / s.distance, 1, 1e-3f);
      EXPECT_NEAR(density * s.weight * float(n * n) * float(emission(light).x) / hit.radiance.x, 1, 1e-3f);
      bright += hit.radiance.x > 5;
    }
  EXPECT_NEAR(bright / double(n * n), .9 * .75 + .1 * .25, .02);
  EXPECT_EQ(sampling_density(light, lit.point({0, 2, 0}), normal, {0, -1, 0}), 0);
}

// Claim: a ball is sampled evenly in its cone, at the density that it states; from within the bounding sphere of a cube, by
// points of its surface. Source: light.h. Tolerance: 1e-3, and a hundredth of the samples beside the mesh. Fails if: points are
// sampled from outside, where weights near the ball differ by a factor of 10, or the density is that of points.
TEST(ShapeLights, RoundOnesAreSampledInTheirCone) {
  const auto weights_at = [](const std::string& shape, const Vec3d& at) {
    const EmittingScene lit(parse_scene(R"({"shapes": [{)" + shape + R"(, "emission": 1}]})", "a.json"));
    const Vec3f point = lit.point(at), normal{0, 1, 0};
    std::vector<float> weights;
    const int n = 32;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const LightSample s = sample_light(lit.lights.at(0), point, normal, {(i + .5) / n, (j + .5) / n}, 1);
        if (!(s.weight > 0)) continue;
        weights.push_back(s.weight);
        EXPECT_NEAR(sampling_density(lit.lights.at(0), point, normal, s.direction) * s.weight, 1, 1e-3f);
      }
    return weights;
  };
  const std::vector<float> ball = weights_at(R"("sphere": {"center": [0, 3, 0], "radius": 2})", {0, .5, 0});
  EXPECT_GE(ball.size(), 1014u);
  const auto [least, most] = std::ranges::minmax(ball);
  EXPECT_NEAR(double(least), 2 * pi * (1 - std::sqrt(1 - 4 / 6.25)), 1e-3);
  EXPECT_NEAR(most / least, 1, 1e-3f);
  const std::vector<float> cube = weights_at(R"("box": {"low": [-1, 1, -1], "high": [1, 3, 1]})", {0, .8, 0});
  EXPECT_FALSE(cube.empty());
  EXPECT_GT(std::ranges::max(cube), 2 * std::ranges::min(cube));
}

}  // namespace
}  // namespace opaline
