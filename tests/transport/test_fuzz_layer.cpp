// SPDX-License-Identifier: GPL-3.0-or-later
// Fibres on a surface, against published albedos, their own integral, and random walks.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <tuple>

#include "transport/fuzz_layer.h"
#include "transport/outer_boundary.h"

namespace opaline {
namespace {

/// Reflectance of the layer at a cosine, by random walks, and its standard error.
std::pair<double, double> walked_reflectance(double cosine, double s, int walks) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  const auto area = [&](const Vec3d& d) { return std::sqrt(d.x * d.x + d.y * d.y + s * s * d.z * d.z); };
  int reflected = 0;
  for (int walk = 0; walk < walks; ++walk) {
    Vec3d d{std::sqrt(1 - cosine * cosine), 0, -cosine};
    double depth = 0;
    while (true) {
      depth -= d.z * -std::log(1 - uniform(random)) / area(d);
      if (depth < 0) ++reflected;
      if (depth < 0 || depth > 1) break;
      // Directions by rejection: the density of normals at the half vector, over its maximum 1/(pi s).
      while (true) {
        const double z = 2 * uniform(random) - 1, sine = std::sqrt(1 - z * z),
                     angle = 2 * std::numbers::pi * uniform(random);
        const Vec3d next{sine * std::cos(angle), sine * std::sin(angle), z}, half = normalized(next - d);
        const double inverse = half.x * half.x + half.y * half.y + half.z * half.z / (s * s);
        if (uniform(random) * inverse * inverse > 1) continue;
        d = next;
        break;
      }
    }
  }
  const double mean = double(reflected) / walks;
  return {mean, std::sqrt(mean * (1 - mean) / walks)};
}

// Claim: the albedo of isotropic flakes. Source: an independent program's, all orders of scattering, optical
// thickness 1. Tolerance: .001, the table's error. Fails if: single scattering alone is tabulated (58 % low), or
// the half vector of the transfer has the wrong sign in other roughnesses (see below).
TEST(FuzzLayer, AlbedoOfIsotropicFlakes) {
  const FuzzLayer fuzz(1);
  EXPECT_NEAR(fuzz.reflectance(1), .34132876, .001);
  EXPECT_NEAR(fuzz.reflectance(.5), .49837553, .001);
  EXPECT_NEAR(fuzz.reflectance(.2f), .64596749, .001);
}

// Claim: the albedo of fibres along the normal. Source: random walks here. Tolerance: 3 standard errors (.005 at
// most) and .0005. Fails if: the half vector of the transfer has the wrong sign (2 times).
TEST(FuzzLayer, AlbedoOfFibres) {
  for (const double roughness : {.25, .5, .8}) {
    const FuzzLayer fuzz(roughness);
    for (const double cosine : {1., .5, .1, .02}) {
      const auto [walked, error] = walked_reflectance(cosine, roughness * roughness, 100000);
      EXPECT_NEAR(fuzz.reflectance(float(cosine)), walked, 3 * error + .0005) << roughness << ' ' << cosine;
    }
  }
}

// Claim: the BRDF's integral is the tabulated albedo, and it is reciprocal. Source: definitions. Tolerance: .6 % and
// .0005 of midpoint rules; rounding. Fails if: a factor of pi, or a cosine, is missing in one of its two terms.
TEST(FuzzLayer, IntegralAndReciprocity) {
  for (const double roughness : {0., .5, 1.}) {
    const FuzzLayer fuzz(roughness);
    for (const float view : {1.f, .5f, .2f, .05f}) {
      constexpr int kSteps = 600;
      double sum = 0;
      const float sine = std::sqrt(1 - view * view);
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
          const float light = (float(i) + .5f) / kSteps,
                      azimuth = 2 * std::numbers::pi_v<float> * (float(j) + .5f) / kSteps;
          const float between = view * light + sine * std::sqrt(1 - light * light) * std::cos(azimuth);
          const float value = fuzz.value(view, light, between);
          sum += double(value) * double(light) * 2 * std::numbers::pi / kSteps / kSteps;
          if (i % 50 == 0) {
            EXPECT_NEAR(value, fuzz.value(light, view, between), 1e-5f * value);
          }
        }
      EXPECT_NEAR(sum, fuzz.reflectance(view), .006 * sum + .0005) << roughness << ' ' << view;
    }
    double average = 0;
    for (int i = 0; i < 1000; ++i) {
      const double cosine = (i + .5) / 1000;
      average += 2 * cosine * double(fuzz.reflectance(float(cosine))) / 1000;
    }
    EXPECT_NEAR(fuzz.average_reflectance(), average, 1e-3);
  }
}

// Claim: extremes are finite and in range: grazing directions, light from behind, forward scattering. Source:
// definitions. Fails if: a cosine of 0 divides.
TEST(FuzzLayer, Extremes) {
  for (const double roughness : {0., .25, 1.}) {
    const FuzzLayer fuzz(roughness);
    for (const float cosine : {0.f, 1e-30f, 1e-6f, 1.f, 2.f}) {
      EXPECT_GE(fuzz.reflectance(cosine), 0);
      EXPECT_LE(fuzz.reflectance(cosine), 1);
      for (const float other : {0.f, 1e-30f, 1.f})
        for (const float between : {-1.f, 0.f, 1.f}) {
          const float value = fuzz.value(cosine, other, between);
          EXPECT_TRUE(std::isfinite(value) && value >= 0) << roughness << ' ' << cosine << ' ' << other;
        }
    }
    EXPECT_EQ(fuzz.value(-.5f, .5f, 0), 0);
    EXPECT_EQ(fuzz.value(.5f, -.5f, 0), 0);
  }
}

// Claim: a boundary without fuzz transmits as Fresnel's formulas, bit by bit; a weight scales the light held back.
// Source: definitions. Tolerance: rounding. Fails if: the weight is applied twice.
TEST(OuterBoundary, TransmitsPastFuzz) {
  EXPECT_EQ(OuterBoundary().transmittance(.4f), 1);
  EXPECT_EQ(OuterBoundary(1.4).transmittance(.4f), fresnel_transmittance(.4f, 1.4f));
  const OuterBoundary half(1.4, {.weight = .5, .roughness = 1}), all(1.4, {.weight = 1, .roughness = 1});
  const float fresnel = fresnel_transmittance(.4f, 1.4f), held = FuzzLayer(1).reflectance(.4f);
  EXPECT_NEAR(all.transmittance(.4f), fresnel * (1 - held), 1e-6);
  EXPECT_NEAR(half.transmittance(.4f), fresnel * (1 - .5f * held), 1e-6);
  EXPECT_TRUE(OuterBoundary(1.4, {.weight = 0, .roughness = 1}) == OuterBoundary(1.4));
  EXPECT_FALSE(half == all);
  EXPECT_NE(half.number(), all.number());
}

// Claim: a textured boundary transmits at a point by the mixture of layers there, which is reciprocal, and equals others with equal textures
// only. Source: definitions. Tolerance: rounding. Fails if: the largest weight is used at points, or textures do not count.
TEST(OuterBoundary, IsThatOfThePoint) {
  const FuzzLayer &flat = *shared_fuzz(.4), &rough = *shared_fuzz(.8);
  const auto textures = [&](std::uint64_t hash) {
    return std::make_shared<const FuzzTextures>(
        FuzzTextures{[&](const SurfacePoint& point) {
                       return point.u > 0 ? LocalFuzz{.5f, &flat, &rough, .25f} : LocalFuzz{};
                     },
                     hash});
  };
  const Fuzz fuzz{.weight = 1, .roughness = 1};
  const OuterBoundary boundary(1.4, fuzz, textures(1));
  EXPECT_TRUE(boundary.is_textured() && boundary.has_fuzz());
  SurfacePoint bare, covered;
  covered.u = .5f;
  EXPECT_TRUE(boundary.at(bare) == OuterBoundary(1.4));
  const OuterBoundary here = boundary.at(covered);
  EXPECT_FALSE(here.is_textured());
  const float held = .75f * flat.reflectance(.3f) + .25f * rough.reflectance(.3f);
  EXPECT_NEAR(here.transmittance(.3f), fresnel_transmittance(.3f, 1.4f) * (1 - .5f * held), 1e-6);
  EXPECT_NEAR(here.past_fuzz(),
              1 - .5f * (.75f * flat.average_reflectance() + .25f * rough.average_reflectance()), 1e-6);
  EXPECT_NEAR(here.fuzz_value(.3f, .8f, .5f), here.fuzz_value(.8f, .3f, .5f), 1e-6);
  EXPECT_TRUE(boundary == OuterBoundary(1.4, fuzz, textures(1)));
  EXPECT_FALSE(boundary == OuterBoundary(1.4, fuzz, textures(2)));
  EXPECT_FALSE(boundary == OuterBoundary(1.4, fuzz));
}

}  // namespace
}  // namespace opaline
