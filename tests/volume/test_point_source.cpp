// SPDX-License-Identifier: GPL-3.0-or-later
// The fluence around a point source.
#include "diffusion/diffusion_test.h"
#include "support/point_source_walks.h"
#include "transport/point_source.h"
#include "volume_test.h"

namespace opaline {
namespace {

using test::expect_walked;
using test::medium_of_albedo;
using test::walk_point_source;
using test::WalkedShell;
using test::walks_of_seed;

// Claim: the decay far from a source. Source: Case, de Hoffmann & Placzek 1953, table of 1/kappa; kappa^2 = 3 (1-c)
// (1 - 2/5 (1-c)) as c goes to 1. Tolerance: their digits; the next term of the series. Fails if: kappa is
// diffusion's.
TEST(PointSource, DecayConstant) {
  const std::pair<double, double> rows[] = {
      {.5, .95750402}, {.8, .71041178}, {.9, .52542951}, {.99, .17251107}, {.999, .05475034}};
  for (const auto& [c, kappa] : rows) EXPECT_NEAR(decay_constant(1 - c), kappa, 6e-9) << c;
  for (const double absorbed : {1e-4, 1e-9, 1e-15})
    EXPECT_NEAR(decay_constant(absorbed) / std::sqrt(3 * absorbed * (1 - .4 * absorbed)), 1, absorbed)
        << absorbed;
  EXPECT_EQ(decay_constant(0), 0);
  EXPECT_NEAR(decay_constant(.999), 1, 1e-15);
}

// Claim: all light that the source emits is absorbed: sigma_a times the integral of the fluence is 1. Close by the
// fluence is that of uncollided light, far away that of diffusion where little absorbs. Source: conservation of
// energy; c pi^2 / 2 mean free paths^-1 of scattered light per distance (first collisions near a point). Tolerance:
// quadrature; 1 % of the limits. Fails if: the continuous modes miss a factor, or the discrete one its weight.
TEST(PointSource, ExactFluence) {
  for (const double c : {.05, .5, .9, .99}) {
    const HomogeneousMedium medium = medium_of_albedo(c);
    const auto shell = [&](double s) {  // r = exp(s)
      const double r = std::exp(s);
      return 4 * test::pi * r * r * r * point_source_fluence(medium, r);
    };
    EXPECT_NEAR((1 - c) * test::integral(shell, std::log(1e-6), std::log(700.), 60), 1, 3e-6) << c;
    EXPECT_NEAR(point_source_fluence(medium, .001) * 4 * test::pi * 1e-6, 1, .006) << c;
  }
  const HomogeneousMedium bright{1e-5, 2 - 1e-5, 0, 1};
  EXPECT_NEAR(point_source_fluence(bright, 20) / diffusion_point_fluence(bright, 20), 1, 1e-3);
  EXPECT_EQ(point_source_fluence({2, 0, 0, 1}, 1), std::exp(-2.) / (4 * test::pi));
  EXPECT_NEAR(point_source_fluence({0, 1, 0, 1}, 10) / (3 / (40 * test::pi)), 1, 1e-6);
}

/// The mean over a shell.
double shell_mean(const WalkedShell& shell, const HomogeneousMedium& medium) {
  const auto volume = [&](double r) { return r * r * point_source_fluence(medium, r); };
  return 3 * test::integral(volume, std::max(shell.low, 1e-9), shell.high, 8) /
         (std::pow(shell.high, 3) - std::pow(shell.low, 3));
}

// Claim: walks have the exact fluence from a tenth of a mean free path to where .1 % of the light is left, and the
// approximations are off by what they are: Grosjean's by less than 8 % there, the classical one by far more
// near the source. Source: point_source_fluence. Tolerance: five standard errors, for 21 shells. Fails if: collisions
// are counted after absorption has taken its share, or free paths are not exponential.
TEST(PointSource, Walks) {
  for (const double c : {.5, .8, .95}) {
    const HomogeneousMedium medium = medium_of_albedo(c);
    LaboratorySettings settings = walks_of_seed(60000, 6);
    settings.radii = {.1, .3, .6, 1, 2, 3, 5};
    for (const WalkedShell& shell : walk_point_source(medium, settings)) {
      const double exact = shell_mean(shell, medium);
      EXPECT_NEAR(shell.fluence.value, exact, 5 * shell.fluence.error) << c << " " << shell.high;
      EXPECT_LT(shell.fluence.error, .04 * exact) << c << " " << shell.high;
    }
    for (const double r : {.1, 1., 5.}) {
      const double exact = point_source_fluence(medium, r);
      EXPECT_NEAR(grosjean_point_fluence(medium, r) / exact, 1, .08) << c << " " << r;
    }
    EXPECT_LT(diffusion_point_fluence(medium, .1), .45 * point_source_fluence(medium, .1)) << c;
  }
}

}  // namespace
}  // namespace opaline
