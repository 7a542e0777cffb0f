// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of lights seen from a point, and rays that meet lights.
#include <gtest/gtest.h>

#include "support/lighting.h"

namespace opaline {
namespace {

using namespace test;

/// Sum of f(sample) over n x n places of the unit square.
template <class F>
double sum_over_square(const Light& light, const Vec3f& point, const Vec3f& normal, int n, const F& f) {
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      sum += f(sample_light(light, point, normal, {(i + .5) / n, (j + .5) / n}, n * n));
  return sum;
}

// Claim: the weights of an area light's samples sum to the solid angle it fills, from near, far and aslant:
// cone of a sphere 2 pi (1 - cos), a cube's face from its middle 2 pi / 3; all point at the light, whose
// surface is `distance` away as intersect_emitter sees it. Source: geometry. Tolerance: 1e-3 for the sum
// (midpoint rule); 1e-4 for distances. Fails if: the density is not that of the samples.
TEST(LightSamples, WeightsSumToTheSolidAngle) {
  struct Case {
    Light light;
    double solid_angle;
  };
  const double r = 2, d = 3;
  const double far_cone = 2 * pi * 1e-8 / (1 + std::sqrt(1 - 1e-8));
  for (const Case& c : {Case{unit_sphere_light({0, d, 0}, r), 2 * pi * (1 - std::sqrt(1 - r * r / d / d))},
                        Case{unit_sphere_light({6e3, 8e3, 0}, 1), far_cone},
                        Case{unit_quad_light({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}), 2 * pi / 3},
                        Case{unit_quad_light({-1, 1, -1}, {0, 0, 2}, {2, 0, 0}), 0}}) {
    const Vec3f origin{0, 0, 0};
    const double sum = sum_over_square(c.light, origin, {0, 1, 0}, 64, [&](const LightSample& s) {
      if (s.weight == 0) return 0.;
      EXPECT_NEAR(length(s.direction), 1, 1e-5);
      const EmitterHit hit =
          intersect_emitter(c.light, origin, s.direction, std::numeric_limits<float>::infinity());
      if (c.solid_angle > 1e-3) {  // the rim of a far sphere is thinner than floats
        EXPECT_TRUE(hit.hit);
        EXPECT_NEAR(hit.t / s.distance, 1, c.solid_angle > 1 ? 1e-2 : 1e-4);
        EXPECT_EQ(hit.radiance, RgbF(1));
      }
      return double(s.weight);
    });
    EXPECT_NEAR(sum, c.solid_angle, 1e-3 * c.solid_angle);
  }
}

// Claim: surroundings are drawn by the cosine: the sum of weight x cos is pi, with every term alike, and no
// sample is below the horizon. Source: light.h. Tolerance: 1e-4. Fails if: the density is uniform.
TEST(LightSamples, SurroundingsFollowTheCosine) {
  const Vec3f normal = normalized(Vec3f(1, -2, 3));
  const double sum = sum_over_square(unit_surroundings(), {}, normal, 32, [&](const LightSample& s) {
    const double term = double(s.weight) * double(dot(s.direction, normal));
    EXPECT_NEAR(term, pi / 1024, 1e-4 * pi / 1024);
    EXPECT_TRUE(std::isinf(s.distance));
    return term;
  });
  EXPECT_NEAR(sum, pi, 1e-4 * pi);
}

// Claim: delta lights say so, give 1/d^2 and 1, and are never met by a ray. Source: light.h.
// Tolerance: 1e-6. Fails if: their weight is divided by the samples.
TEST(LightSamples, DeltaLightsAreExact) {
  const Light point = unit_point({0, 4, 0}), sun = unit_directional({0, -1, 0});
  EXPECT_TRUE(is_delta(point) && is_delta(sun));
  EXPECT_FALSE(is_delta(unit_sphere_light({}, 1)) || is_delta(unit_surroundings()) ||
               is_delta(unit_quad_light({}, {1, 0, 0}, {0, 1, 0})));
  const LightSample p = sample_light(point, {}, {0, 1, 0}, {.5, .5}, 1),
                    s = sample_light(sun, {}, {0, 1, 0}, {.5, .5}, 1);
  EXPECT_NEAR(p.weight, 1 / 16., 1e-7);
  EXPECT_NEAR(p.distance, 4, 1e-6);
  EXPECT_EQ(s.weight, 1);
  EXPECT_TRUE(std::isinf(s.distance));
  EXPECT_EQ(s.direction, Vec3f(0, 1, 0));
  EXPECT_FALSE(intersect_emitter(point, {}, {0, 1, 0}, 100).hit);
  EXPECT_FALSE(intersect_emitter(sun, {}, {0, 1, 0}, 100).hit);
}

// Claim: a ray meets a sphere or quad light where it is, not beyond `far`, not behind, and a quad from its
// front alone. Source: geometry. Tolerance: 1e-6. Fails if: far is ignored, or the quad's side.
TEST(LightSamples, RaysMeetAreaLights) {
  const Light ball = unit_sphere_light({0, 5, 0}, 2),
              quad = unit_quad_light({-1, 4, -1}, {2, 0, 0}, {0, 0, 2});
  EXPECT_NEAR(intersect_emitter(ball, {}, {0, 1, 0}, 100).t, 3, 1e-6);
  EXPECT_NEAR(intersect_emitter(quad, {}, {0, 1, 0}, 100).t, 4, 1e-6);
  EXPECT_FALSE(intersect_emitter(ball, {}, {0, 1, 0}, 2.9f).hit);
  EXPECT_FALSE(intersect_emitter(quad, {}, {0, 1, 0}, 3.9f).hit);
  EXPECT_FALSE(intersect_emitter(ball, {}, {0, -1, 0}, 100).hit);
  EXPECT_FALSE(intersect_emitter(quad, {}, {0, -1, 0}, 100).hit);
  EXPECT_FALSE(intersect_emitter(ball, {2.1f, 0, 0}, {0, 1, 0}, 100).hit);
  EXPECT_FALSE(intersect_emitter(quad, {1.1f, 0, 0}, {0, 1, 0}, 100).hit);
  EXPECT_FALSE(intersect_emitter(quad, {0, 9, 0}, {0, -1, 0}, 100).hit);
}

// Claim: emission is the light's colour, and recentring moves places and nothing else. Source:
// light.h. Tolerance: none. Fails if: directions are moved too.
TEST(LightSamples, ColourAndPlace) {
  const Light sphere = light_of(SphereLight{{1, 2, 3}, 4, {5, 6, 7}});
  EXPECT_EQ(emission(sphere), Rgb(5, 6, 7));
  EXPECT_EQ(emission(light_of(PointLight{{}, {1, 2, 3}})), Rgb(1, 2, 3));
  EXPECT_EQ(emission(light_of(DirectionalLight{{0, 0, 1}, {1, 2, 3}})), Rgb(1, 2, 3));
  EXPECT_EQ(emission(light_of(Surroundings{{1, 2, 3}})), Rgb(1, 2, 3));
  const auto moved = std::get<SphereLight>(recentred(sphere, {1, 1, 1}).source);
  EXPECT_EQ(moved.center, Vec3d(0, 1, 2));
  EXPECT_EQ(moved.radius, 4);
  const Light sun = unit_directional({0, 0, 1});
  EXPECT_EQ(std::get<DirectionalLight>(recentred(sun, {1, 1, 1}).source).direction, Vec3d(0, 0, 1));
  const Light quad = unit_quad_light({1, 2, 3}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(std::get<QuadLight>(recentred(quad, {1, 1, 1}).source).u, Vec3d(1, 0, 0));
  EXPECT_EQ(std::get<QuadLight>(recentred(quad, {1, 1, 1}).source).corner, Vec3d(0, 1, 2));
}

// Claim: a spot light is a point light along its middle, fades beyond the inner angle and ends at the rim. Source:
// KHR_lights_punctual's formula, by hand. Tolerance: 1e-6. Fails if: angles are full ones, or the ramp is in degrees.
TEST(LightSamples, SpotFadesToItsRim) {
  SpotLight spot{{0, 2, 0}, {0, -1, 0}, Rgb(1)};
  spot.inner_angle = 20;
  spot.outer_angle = 40;
  const auto weight = [&](double degrees) {  // on the floor, seen at this angle
    const Vec3f point(float(2 * std::tan(degrees * pi / 180)), 0, 0);
    return double(sample_light(light_of(spot), point, {0, 1, 0}, {}, 1).weight) *
           std::pow(2 / std::cos(degrees * pi / 180), 2);
  };
  const auto cosine = [](double degrees) { return std::cos(degrees * pi / 180); };
  EXPECT_NEAR(weight(0), 1, 1e-6);
  EXPECT_NEAR(weight(19.9), 1, 1e-6);
  EXPECT_NEAR(weight(30), std::pow((cosine(30) - cosine(40)) / (cosine(20) - cosine(40)), 2), 1e-6);
  EXPECT_EQ(weight(40.1), 0);
  EXPECT_EQ(sample_light(light_of(spot), {0, 3, 0}, {0, 1, 0}, {}, 1).weight, 0);
  EXPECT_TRUE(is_delta(light_of(spot)));
}

// Claim: a sun with an angle sends the irradiance it says to a surface that faces it, cos times that to others, from
// directions within its disc, and its disc's radiance is what a camera sees. Source: the integral of the cosine over
// a disc of half angle a is pi sin^2 a. Tolerance: 1e-4. Fails if: weights are per solid angle without the cosine,
// or the angle is taken as half.
TEST(LightSamples, SunWithAnAngle) {
  DirectionalLight sun{normalized(Vec3d(1, -2, 2)), Rgb(1)};
  sun.angle = 30;
  const Light light = light_of(sun);
  for (const double tilt : {0., 50.}) {
    Vec3d x, y;
    tangent_frame(-sun.direction, x, y);
    const Vec3d normal = -sun.direction * std::cos(tilt * pi / 180) + x * std::sin(tilt * pi / 180);
    const double sum = sum_over_square(light, {}, Vec3f(normal), 64, [&](const LightSample& s) {
      EXPECT_GE(-dot(Vec3d(s.direction), sun.direction), std::cos(15.001 * pi / 180));
      return double(s.weight) * dot(Vec3d(s.direction), normal);
    });
    EXPECT_NEAR(sum, std::cos(tilt * pi / 180), 1e-4) << tilt;
  }
  const double radiance = 1 / (pi * std::pow(std::sin(15 * pi / 180), 2));
  EXPECT_NEAR(double(background(light, Vec3f(-sun.direction)).x), radiance, 1e-4 * radiance);
  Vec3d x, y;
  tangent_frame(-sun.direction, x, y);
  const auto aside = [&](double degrees) {
    return Vec3f(-sun.direction * std::cos(degrees * pi / 180) + x * std::sin(degrees * pi / 180));
  };
  EXPECT_GT(background(light, aside(14.9)).x, 0);
  EXPECT_EQ(background(light, aside(15.1)).x, 0);
  EXPECT_FALSE(is_delta(light));
}

}  // namespace
}  // namespace opaline
