// SPDX-License-Identifier: GPL-3.0-or-later
// The rough mirror, against quadrature of its own formulas and against the smooth one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "transport/fresnel.h"
#include "transport/rough_boundary.h"

namespace opaline {
namespace {

Vec3f direction_at(float cosine, float phi = 0) {
  const float sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

// Claim: sampling, the reflectance function and the table of reflectances are one thing: the function's integral over
// the hemisphere (midpoint rule) is the samples' mean weight and the table's value. Tolerance .003, of which the rule has
// less than .001. Fails if: the Jacobian is 1/2 instead of 1/4, or shadowing is that of one side.
TEST(RoughBoundary, SamplesAndTableAreTheIntegral) {
  for (const double roughness : {.3, .6, 1.})
    for (const double eta : {.75, 1.3, 1.5})
      for (const float cosine : {.1f, .5f, .9f, 1.f}) {
        const RoughBoundary boundary(roughness, eta);
        const Vec3f view = direction_at(cosine);
        constexpr int kSteps = 500;
        double integral = 0, density = 0, sampled = 0;
        for (int i = 0; i < kSteps; ++i)
          for (int j = 0; j < kSteps; ++j) {
            const Vec3f light = direction_at((float(i) + .5f) / kSteps,
                                             2 * std::numbers::pi_v<float> * (float(j) + .5f) / kSteps);
            integral += double(boundary.value(view, light));
            density += double(boundary.density(view, light));
          }
        const double step = 2 * std::numbers::pi / kSteps / kSteps;
        constexpr int kSamples = 16384;
        for (int s = 0; s < kSamples; ++s)
          sampled += double(boundary.sample(view, r2_point(std::uint64_t(s), {.5, .5})).weight) / kSamples;
        SCOPED_TRACE(testing::Message() << roughness << ' ' << eta << ' ' << cosine);
        EXPECT_NEAR(integral * step, sampled, .003);
        EXPECT_NEAR(boundary.reflectance(cosine), sampled, .003);
        EXPECT_LE(density * step, 1.005);
      }
}

struct Integrals {
  double reflected = 0, density = 0;
};

// Over the hemisphere of light, by the midpoint rule in cos and azimuth.
Integrals integrals(const RoughBoundary& boundary, const Vec3f& view, int steps) {
  Integrals sums;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const Vec3f light = direction_at((float(i) + .5f) / float(steps),
                                       2 * std::numbers::pi_v<float> * (float(j) + .5f) / float(steps));
      sums.reflected += double(boundary.value(view, light));
      sums.density += double(boundary.density(view, light));
    }
  const double step = 2 * std::numbers::pi / steps / steps;
  return {sums.reflected * step, sums.density * step};
}

// Claim: the alphas of an anisotropic boundary are OpenPBR's: their ratio is 1 - anisotropy, the mean of their squares that
// of the isotropic one. Source: OpenPBR 1.1. Tolerance: rounding. Fails if: the root is left out.
TEST(RoughBoundary, AlphasAreThoseOfOpenPbr) {
  const FacetAlphas alphas = facet_alphas(.6f, .7f);
  EXPECT_NEAR(alphas.across / alphas.along, .3, 1e-6);
  EXPECT_NEAR((alphas.along * alphas.along + alphas.across * alphas.across) / 2, std::pow(.36, 2), 1e-6);
  EXPECT_EQ(facet_alphas(.6f), (FacetAlphas{.36f, .36f}));
  EXPECT_GT(facet_alphas(.6f, 1).across, 0);
}

// Claim: seen from any side, sampling, the reflectance function, the density and the range's tables are one thing; the
// density's integral is the share of samples that go upwards, all but those that would meet a second facet. Tolerance: of
// the tables, between whose nine sides lie others, .006; else .004, of which the rule has less than .001. Fails if: an
// alpha is taken for the other anywhere, or tables are those of another side (.05).
TEST(RoughBoundary, AnisotropicOnesAreConsistent) {
  for (const float anisotropy : {.3f, .8f})
    for (const float roughness : {.4f, .8f}) {
      const RoughnessRange one(1.5, anisotropy, roughness), all(1.5, anisotropy);
      for (const float cosine : {.15f, .6f, 1.f})
        for (const float azimuth : {0.f, 1.2f, 1.5708f, 4.f}) {
          const Vec3f view = direction_at(cosine, azimuth);
          const float share = std::pow(std::cos(azimuth), 2.0f);
          const RoughBoundary boundary(facet_alphas(roughness, anisotropy), 1.5, share);
          double sampled = 0, upward = 0;
          constexpr int kSamples = 16384;
          for (int s = 0; s < kSamples; ++s) {
            const auto [light, weight] = boundary.sample(view, r2_point(std::uint64_t(s), {.5, .5}));
            sampled += double(weight) / kSamples;
            upward += (light.z > 0 ? 1. : 0.) / kSamples;
          }
          const Integrals integral = integrals(boundary, view, 800);
          SCOPED_TRACE(testing::Message()
                       << anisotropy << ' ' << roughness << ' ' << cosine << ' ' << azimuth);
          EXPECT_NEAR(integral.reflected, sampled, .004);
          EXPECT_NEAR(integral.density, upward, .004);
          EXPECT_NEAR(boundary.reflectance(cosine), sampled, .003);
          EXPECT_NEAR(one.at(roughness, share).reflectance(cosine), sampled, .006);
          EXPECT_NEAR(all.at(roughness, share).reflectance(cosine), sampled, .006);
        }
    }
}

// Claim: between tabulated anisotropies and roughnesses, reflectances are those of the boundary. Source: its own table. Tolerance:
// .018 at most, of facets level across; .002 on average. Fails if: the lower anisotropy is taken (.04).
TEST(RoughBoundary, AnisotropiesBetweenTablesAreInterpolated) {
  const AnisotropyRange range(1.5);
  double sum = 0;
  constexpr int kCases = 60;
  for (std::uint64_t i = 0; i < kCases; ++i) {
    const auto [a, b, c, d] = r4_point(i, {.3, .1, .6, .8});
    const FacetAlphas alphas = facet_alphas(float(.1 + .9 * a), float(b));
    const float share = float(c), cosine = float(.05 + .95 * d);
    const RoughBoundary between = range.at(alphas, share), exact(alphas, 1.5, share);
    for (const float error : {between.reflectance(cosine) - exact.reflectance(cosine),
                              between.reflected_once(cosine) - exact.reflected_once(cosine)}) {
      EXPECT_LT(std::abs(error), .018f)
          << alphas.along << ' ' << alphas.across << ' ' << share << ' ' << cosine;
      sum += std::abs(double(error)) / (2 * kCases);
    }
  }
  EXPECT_LT(sum, .002);
}

// Claim: light and eye may change places. Source: Helmholtz. Tolerance: rounding. Fails if: masking is not symmetric.
TEST(RoughBoundary, IsReciprocal) {
  const RoughBoundary boundary(.5, 1.5);
  for (const float a : {.2f, .7f})
    for (const float b : {.3f, .95f}) {
      const Vec3f one = direction_at(a), other = direction_at(b, 2);
      for (const RoughBoundary& rough : {boundary, RoughBoundary(facet_alphas(.5f, .8f), 1.5, 0)})
        EXPECT_NEAR(rough.value(one, other) / other.z / (rough.value(other, one) / one.z), 1, 1e-4);
    }
}

// Claim: as roughness goes to 0 the boundary is Fresnel's. Tolerance .004, the table's steps at grazing angles apart.
// Fails if: roughness is not squared, or facets are drawn around the view instead of the normal.
TEST(RoughBoundary, IsFresnelsWhereItIsSmooth) {
  for (const double eta : {1.3, 1.5}) {
    const RoughBoundary boundary(.05, eta);
    for (const float cosine : {.25f, .5f, .75f, 1.f})
      EXPECT_NEAR(boundary.reflectance(cosine), fresnel_reflectance(cosine, float(eta)), .004) << cosine;
  }
}

}  // namespace
}  // namespace opaline
