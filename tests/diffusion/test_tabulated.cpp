// SPDX-License-Identifier: GPL-3.0-or-later
// The profile of random walks.
#include <bit>

#include "diffusion/diffusion_test.h"
#include "transport/half_space.h"
#include "transport/laboratory.h"
#include "transport/point_source.h"

namespace opaline {
namespace {

using namespace test;

TabulatedProfile tabulated(double mean_free_path, double absorbed, double eta) {
  return make_profile({mean_free_path, absorbed, eta}, std::type_identity<TabulatedProfile>());
}

// Claim: the profile is what walks of another seed have: the total exactly, the share within any distance to .012, the
// shape to 3 % in L1. Source: the laboratory, 5 to 10 times as many walks. Tolerance: that, of which a half is the
// table's own noise. Fails if: rings are shifted by one, the smoothing bends the fall, or light enters along the normal.
TEST(Tabulated, IsTheLongerWalk) {
  for (const auto& [absorbed, eta] : {std::pair(.0023, 1.5), std::pair(.04, 1.3), std::pair(.5, 1.)}) {
    const TabulatedProfile profile = tabulated(1, absorbed, eta);
    LaboratorySettings settings;
    settings.seed = 77;
    settings.walks = absorbed < .01 ? 60000 : 200000;
    const SlabWalks walked = walk_slab({absorbed, 1 - absorbed, 0, eta}, {}, kDiffuseEntry, settings);
    EXPECT_NEAR(profile.total, walked.back.total.value, 4 * walked.back.total.error);
    double l1 = 0, before = 0;
    for (const WalkedRing& ring : walked.back.rings) {
      const double within = diffuse_reflectance_within(profile, ring.high);
      EXPECT_NEAR(within / profile.total, ring.within.value / walked.back.total.value, .012) << ring.high;
      l1 += std::abs(within - before - ring.share.value) / profile.total;
      before = within;
    }
    EXPECT_LT(l1, .03) << absorbed << " " << eta;
  }
}

// Claim: within(r) is the integral of R_d, from a ten-thousandth of a mean free path to thousands, and within and the
// inverse agree. Source: quadrature. Tolerance: 5e-6, for the quadrature runs across the first knot. Fails if: the power law before the first knot or the tail after
// the last has another integral than its value says.
TEST(Tabulated, Integrals) {
  for (const double absorbed : {0., .001, .3}) {
    const TabulatedProfile profile = tabulated(.38, absorbed, 1.5);
    for (const double r : {1e-5, 3e-4, .01, .38, 3., 40., 1000.})
      EXPECT_NEAR(diffuse_reflectance_within(profile, r) /
                      plane_integral([&](double x) { return diffuse_reflectance_profile(profile, x); },
                                     std::min(r, .38), r),
                  1, 5e-6)
          << absorbed << " " << r;
    for (const double share : {.999999, .9, .3, 1e-3, 1e-8}) {
      const double r = sample_diffusion_distance(profile, share);
      EXPECT_NEAR(diffuse_reflectance_within(profile, r), profile.total * (1 - share), 1e-12) << share;
    }
  }
}

// Claim: it falls everywhere, without a jump, and far away as (1 + kappa r) exp(-kappa r) / r^3 with the exact decay.
// Source: Case & Zweifel's discrete mode. Tolerance: 1e-3 over a factor of 1e5 and more. Fails if: kappa is the
// diffusion theory's (18 % off at absorbed .3).
TEST(Tabulated, FallsToTheExactDecay) {
  for (const double absorbed : {0., 1e-6, .01, .3}) {
    const TabulatedProfile profile = tabulated(1, absorbed, 1.3);
    double before = INFINITY;
    for (double r = 1e-6; r < 1e7; r *= 1.01) {
      const double now = diffuse_reflectance_profile(profile, r);
      ASSERT_LE(now, before) << absorbed << " " << r;
      if (before < INFINITY && now > 1e-280) {
        ASSERT_GT(now / before, std::exp(-.0101 * (r + 4))) << absorbed << " " << r;
      }
      before = now;
    }
    const double kappa = decay_constant(absorbed);
    EXPECT_EQ(slowest_decay(profile), kappa);
    const auto mode = [&](double r) { return (1 + kappa * r) * std::exp(-kappa * r) / (r * r * r); };
    const double near = 3000, far = absorbed == 0 ? 1e6 : near + 12 / kappa;
    const double ratio =
        diffuse_reflectance_profile(profile, far) / diffuse_reflectance_profile(profile, near);
    if (absorbed < 1e-3) {
      EXPECT_NEAR(ratio / (mode(far) / mode(near)), 1, 1e-3) << absorbed;
    }
  }
}

// Claim: the same medium has the same bits at another length, and when it is asked for again. Source: the contract.
// Tolerance: none. Fails if: the seed or the number of walks depends on lengths or time.
TEST(Tabulated, SameBits) {
  const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v); };
  const TabulatedProfile a = tabulated(1, .02, 1.4), b = tabulated(8, .02, 1.4);
  for (const double r : {.01, 1., 30.}) {
    EXPECT_EQ(bits(diffuse_reflectance_profile(a, r)), bits(64 * diffuse_reflectance_profile(b, 8 * r)));
    EXPECT_EQ(bits(diffuse_reflectance_within(a, r)), bits(diffuse_reflectance_within(b, 8 * r)));
  }
}

// Claim: a table that is handed over in its numbers is the one that was walked. Source: the contract. Tolerance: none.
// Fails if: the constructor changes the numbers that it was made from once more.
TEST(Tabulated, HandedOver) {
  const TabulatedProfile a = tabulated(1, .03, 1.4);
  const RadialTable& walked = a.shape->get().table;
  const RadialTable copy(walked.reference(), walked.logarithms());
  for (double r = 1e-4; r < 1e3; r *= 1.7) EXPECT_EQ(copy.density(r), walked.density(r)) << r;
}

}  // namespace
}  // namespace opaline
