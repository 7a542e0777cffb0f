// SPDX-License-Identifier: GPL-3.0-or-later
// The normalized diffusion profile.
#include "diffusion/diffusion_test.h"

namespace opaline {
namespace {

using namespace test;

// Claim: R_d = A (e^(-r/d) + e^(-r/3d))/(8 pi d r). Source: Christensen & Burley 2015, equation 2. Tolerance:
// 1e-14 relative. Fails if: 3d is d/3.
TEST(NormalizedDiffusion, IsTheFormula) {
  const NormalizedDiffusion profile{.8, .5};
  for (const double r : {1e-9, .01, .5, 3., 20.})
    EXPECT_NEAR(diffuse_reflectance_profile(profile, r) * 8 * pi * .5 * r / .8 /
                    (std::exp(-r / .5) + std::exp(-r / 1.5)),
                1, 1e-14);
}

// Claim: d = l/(1.9 - A + 3.5 (A - .8)^2), the fit for diffuse entry; and through a medium A is the dipole's
// total, l the mean free path. Source: the same, equation 7. Tolerance: 1e-14. Fails if: the searchlight fit
// is used.
TEST(NormalizedDiffusion, ShapeLength) {
  for (const double A : {0., .2, .5, .8, 1.})
    EXPECT_NEAR(make_normalized_diffusion(.4, A).d, .4 / (1.9 - A + 3.5 * (A - .8) * (A - .8)), 1e-14) << A;
  const Medium dipole = medium_of(Rgb(.01), Rgb{.99, 1.99, 2.99}, 1.5);
  Medium burley = dipole;
  burley.profile = ProfileKind::normalized_diffusion;
  const DiffuseProfile a = make_diffuse_profile(dipole), b = make_diffuse_profile(burley);
  for (std::size_t c = 0; c < 3; ++c) {
    ASSERT_TRUE(std::holds_alternative<NormalizedDiffusion>(b.channels[c]));
    ASSERT_TRUE(std::holds_alternative<Dipole>(a.channels[c]));
    EXPECT_NEAR(b.total[c], a.total[c], 1e-14);
    EXPECT_NEAR(b.mean_free_path[c], 1. / double(c + 1), 1e-14);
    const NormalizedDiffusion expected = make_normalized_diffusion(1. / double(c + 1), a.total[c]);
    EXPECT_NEAR(std::get<NormalizedDiffusion>(b.channels[c]).d, expected.d, 1e-14);
  }
}

// Claim: it integrates to A, its running integral is the closed form, .996379 of it within 16 d, and the mean
// radius is 2.5 d. Source: integrals by quadrature. Tolerance: 1e-11; half the printed digit for .996379.
// Fails if: the weights 1/4 and 3/4 are swapped.
TEST(NormalizedDiffusion, Integrals) {
  const NormalizedDiffusion profile{.7, .365};
  const auto R_d = [&](double r) { return diffuse_reflectance_profile(profile, r); };
  EXPECT_NEAR(plane_integral(R_d, .365, 200 * .365), .7, 1e-11);
  EXPECT_NEAR(total_diffuse_reflectance(profile), .7, 1e-15);
  EXPECT_NEAR(plane_integral([&](double r) { return r * R_d(r); }, .365, 200 * .365) / .7, 2.5 * .365, 1e-11);
  EXPECT_NEAR(diffuse_reflectance_within(profile, 16 * .365) / .7, .996379, 5e-7);
  for (const double r : {1e-3, .1, 1., 10.})
    EXPECT_NEAR(diffuse_reflectance_within(profile, r) / plane_integral(R_d, .365, r), 1, 1e-11) << r;
}

// Claim: within(r) keeps its digits where r is tiny: A r / (2 d) to first order. Source: series. Tolerance:
// 1e-6 at r = 1e-9 d, far above the second-order term and below what 1 - e^x loses. Fails if: 1 - exp is
// written out.
TEST(NormalizedDiffusion, WithinTinyRadii) {
  const NormalizedDiffusion profile{1, 1};
  EXPECT_EQ(diffuse_reflectance_within(profile, 0), 0);
  EXPECT_NEAR(diffuse_reflectance_within(profile, 1e-9) / .5e-9, 1, 1e-6);
}

}  // namespace
}  // namespace opaline
