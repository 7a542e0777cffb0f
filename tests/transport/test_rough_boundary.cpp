// SPDX-License-Identifier: GPL-3.0-or-later
// The rough mirror, against quadrature of its own formulas and against the smooth one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "opaline/core/random.h"
#include "opaline/transport/fresnel.h"
#include "opaline/transport/rough_boundary.h"

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

// Claim: light and eye may change places. Source: Helmholtz. Tolerance: rounding. Fails if: masking is not symmetric.
TEST(RoughBoundary, IsReciprocal) {
  const RoughBoundary boundary(.5, 1.5);
  for (const float a : {.2f, .7f})
    for (const float b : {.3f, .95f}) {
      const Vec3f one = direction_at(a), other = direction_at(b, 2);
      EXPECT_NEAR(boundary.value(one, other) / other.z / (boundary.value(other, one) / one.z), 1, 1e-4);
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
