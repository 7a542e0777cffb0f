// SPDX-License-Identifier: GPL-3.0-or-later
// The pieces that walks are made of.
#include "support/statistics.h"
#include "transport/control_regression.h"
#include "transport/random_walk.h"
#include "volume_test.h"

namespace opaline {
namespace {

// Claim: sampled cosines have the density of Henyey & Greenstein: their cumulative distribution, whose closed form is
// ((1 - g^2) / sqrt(1 + g^2 - 2 g c) - (1 - g)) / (2 g), is uniform; no digits are lost around g = 0 and at +-.999.
// Source: Henyey & Greenstein 1941, integrated. Tolerance: chi-square at 1e-4 over all g. Fails if: the sign of g is
// turned around, or the usual formula is used at g = 1e-9.
TEST(WalkPieces, HenyeyGreenstein) {
  const double all_g[] = {-.999, -.95, -.3, .5, .95, .999};
  for (const double g : all_g) {
    std::vector<double> uniform;
    WalkNumbers numbers(1, 0);
    test::Mean mean;
    for (int i = 0; i < 20000; ++i) {
      const double cosine = sample_henyey_greenstein(g, numbers.next());
      mean.add(cosine);
      uniform.push_back((1 + g) / (2 * g) *
                        ((1 - g) / std::sqrt(1 + g * g - 2 * g * cosine) - (1 - g) / (1 + g)));
    }
    EXPECT_GT(test::uniformity(uniform, 50), test::sidak(1e-4, std::size(all_g))) << g;
    EXPECT_LT(std::abs(mean.errors_from(g)), 4.5) << g;
  }
  for (const double u : {0., .2, .7}) EXPECT_NEAR(sample_henyey_greenstein(1e-9, u), 2 * u - 1, 2e-9) << u;
}

// Claim: a deflected direction is a unit vector at the asked cosine, for any direction and azimuth. Source: geometry.
// Tolerance: rounding. Fails if: the frame is not orthonormal at the poles.
TEST(WalkPieces, Deflected) {
  WalkNumbers numbers(2, 0);
  for (const Vec3d& direction : {Vec3d{0, 0, 1}, Vec3d{0, 0, -1}, Vec3d{.6, 0, -.8}})
    for (const double cosine : {-1., -.5, 0., .99}) {
      const Vec3d turned = deflected(direction, cosine, numbers.next_angle());
      EXPECT_NEAR(length(turned), 1, 1e-15);
      EXPECT_NEAR(dot(turned, direction), cosine, 1e-15);
    }
}

// Claim: refraction keeps the sine times the index, in the plane of incidence, and going out undoes going in; a mirror
// turns the normal part around. Source: Snell's law. Tolerance: rounding. Fails if: eta stands upside down.
TEST(WalkPieces, Refraction) {
  const Vec3d normal{0, 0, 1}, outside{.6, 0, -.8};
  const Vec3d inside = refracted_inward(outside, normal, 1.5);
  EXPECT_NEAR(inside.x, .4, 1e-15);
  EXPECT_LT(inside.z, 0);
  const Vec3d again = refracted_outward(mirrored(inside, normal), normal, 1.5);
  EXPECT_NEAR(again.x, .6, 1e-15);
  EXPECT_NEAR(again.z, .8, 1e-15);
  EXPECT_EQ(inside_reflectance(.1, 1), 0);
  EXPECT_EQ(inside_reflectance(.7, 1.5), 1);  // beyond the critical angle, cosine .745
}

// Claim: a flight leaves, collides and is reflected in proportion to (1-a)... its shares, and free paths to collisions
// are exponential up to the boundary. Source: Beer-Lambert. Tolerance: 4.5 standard errors. Fails if: the reflected
// part is drawn before the collided one is taken out.
TEST(WalkPieces, Flight) {
  const HomogeneousMedium medium{.5, 1.5, 0, 1.5};
  WalkNumbers numbers(3, 0);
  test::Mean collided, distance;
  const Crossing crossing{1 - std::exp(-2 * .4), .3};
  const double leaving = (1 - crossing.collided) * .7;
  for (int i = 0; i < 100000; ++i) {
    const Flight flight = fly(medium, 2, {.4, {0, 0, 1}}, crossing, numbers);
    ASSERT_DOUBLE_EQ(flight.leaving, 2 * leaving);
    ASSERT_DOUBLE_EQ(flight.remaining, 2 * (1 - leaving));
    collided.add(flight.collides ? flight.remaining : 0);
    if (flight.collides) distance.add(flight.distance);
  }
  EXPECT_LT(std::abs(collided.errors_from(2 * crossing.collided)), 4.5);
  // Mean of an exponential of rate 2 cut off at .4: 1/2 - .4 e / (1 - e).
  EXPECT_LT(std::abs(distance.errors_from(.5 - .4 * (1 - crossing.collided) / crossing.collided)), 4.5);
}

// Claim: roulette keeps the mean weight, by weight and by number of collisions. Source: its definition. Tolerance: 4.5
// standard errors. Fails if: survivors are given the threshold, not what makes up for the dead.
TEST(WalkPieces, Roulette) {
  WalkNumbers numbers(4, 0);
  test::Mean light, long_walks;
  for (int i = 0; i < 100000; ++i) {
    double weight = .03;
    light.add(survives(weight, .1, numbers) ? weight : 0);
    weight = .7;
    long_walks.add(survives_long(weight, 4096, numbers) ? weight : 0);
    ASSERT_TRUE(survives_long(weight, 2048, numbers));
    ASSERT_TRUE(survives_long(weight, 256, numbers));
  }
  EXPECT_LT(std::abs(light.errors_from(.03)), 4.5);
  EXPECT_LT(std::abs(long_walks.errors_from(.7)), 4.5);
  double none = 0;
  EXPECT_FALSE(survives(none, 0, numbers));
}

// Claim: what a control of mean 0 explains is taken out of a mean, and its error with it; a control that another
// explains changes nothing, nor does one that is always 0. Source: by hand: y = 3 + 2 x exactly. Tolerance: rounding.
// Fails if: the control's own mean over the batches is taken for 0.
TEST(WalkPieces, ControlRegression) {
  std::vector<std::vector<double>> controls;
  std::vector<double> exact, noisy;
  WalkNumbers numbers(5, 0);
  for (int b = 0; b < 100; ++b) {
    const double x = numbers.next() - .4,
                 noise = numbers.next() - .5;  // the mean of x is not 0, but told to be
    controls.push_back({x, 0, -3 * x});
    exact.push_back(3 + 2 * x);
    noisy.push_back(3 + 2 * x + .1 * noise);
  }
  const ControlRegression regression(controls);
  EXPECT_NEAR(regression.mean(exact).value, 3, 1e-12);
  EXPECT_NEAR(regression.mean(exact).error, 0, 1e-12);
  const WalkedValue mean = regression.mean(noisy);
  EXPECT_NEAR(mean.value, 3, 5 * mean.error);
  EXPECT_NEAR(mean.error, .1 / std::sqrt(12 * 100), .3 * .1 / std::sqrt(12 * 100));
}

}  // namespace
}  // namespace opaline
