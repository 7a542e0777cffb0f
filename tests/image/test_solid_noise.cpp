// SPDX-License-Identifier: GPL-3.0-or-later
// Noise in space: its range, mean, filter and gradient.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"
#include "image/solid_noise.h"

namespace opaline {
namespace {

NoiseParameters parameters(NoisePattern pattern, int octaves = 5) {
  return {
      .pattern = pattern, .size = 4, .octaves = octaves, .seed = 3, .low = {.2, 0, 0}, .high = {.8, 1, 3}};
}

Vec3d random_point(std::uint64_t i) {
  return {400 * unit_double(hash_bits(1, i)), 400 * unit_double(hash_bits(2, i)),
          400 * unit_double(hash_bits(3, i))};
}

// Claim: values lie between low and high, use most of the range, and average to mean(); each channel is low + (high - low)
// by one blend. Tolerance: .01, 4 standard errors of 10^4 points of deviation .25. Fails if mean() is of another pattern,
// or if a channel has a blend of its own.
TEST(SolidNoise, StaysInItsRangeAboutItsMean) {
  for (const NoisePattern pattern : {NoisePattern::clouds, NoisePattern::veins}) {
    const SolidNoise noise(parameters(pattern));
    double sum = 0, least = 1, most = 0;
    for (std::uint64_t i = 0; i < 10000; ++i) {
      const std::array<float, 4> value = noise.at(random_point(i), 0);
      sum += double(value[1]);
      least = std::min(least, double(value[1]));
      most = std::max(most, double(value[1]));
      ASSERT_NEAR(value[0], .2f + .6f * value[1], 1e-5f);
      ASSERT_NEAR(value[2], 3 * value[1], 1e-5f);
      ASSERT_EQ(value[3], 1);
    }
    EXPECT_NEAR(sum / 10000, noise.mean()[1], .01);
    EXPECT_GE(least, 0);
    EXPECT_LE(most, 1);
    EXPECT_LT(least, .1);
    EXPECT_GT(most, .9);
  }
}

// Claim: the filtered value is nearer to the mean over the filter than the value at its middle, at widths from a tenth of the
// size on, and equals it at ten sizes. Source: means of 512 points in a cube. Tolerance: .6 of the unfiltered rms error, or
// .02 of the range. Fails if octaves do not fade, or if veins fade to the value of a sheet.
TEST(SolidNoise, FiltersToItsMean) {
  for (const NoisePattern pattern : {NoisePattern::clouds, NoisePattern::veins}) {
    const SolidNoise noise(parameters(pattern));
    for (const double width : {.04, .4, 1., 2., 4., 40.}) {
      double filtered = 0, unfiltered = 0;
      constexpr int kPlaces = 100, kPoints = 512;
      for (std::uint64_t i = 0; i < kPlaces; ++i) {
        const Vec3d middle = random_point(i);
        double mean = 0;
        for (std::uint64_t k = 0; k < kPoints; ++k) {
          const auto [x, y, z, unused] = r4_point(k, {});
          mean += double(noise.at(middle + Vec3d{x - .5, y - .5, z - .5} * width, 0)[1]) / kPoints;
        }
        filtered += std::pow(double(noise.at(middle, width)[1]) - mean, 2);
        unfiltered += std::pow(double(noise.at(middle, 0)[1]) - mean, 2);
      }
      const double bound = width > 8 ? .02 : std::max(.02, .6 * std::sqrt(unfiltered / kPlaces));
      EXPECT_LT(std::sqrt(filtered / kPlaces), bound) << int(pattern) << ' ' << width;
      if (width >= 4) {
        EXPECT_GT(std::sqrt(unfiltered / kPlaces), .1) << int(pattern) << ' ' << width;
      }
    }
  }
}

// Claim: values and gradients are continuous across the faces of cells, and the gradient predicts differences. Tolerance:
// 2 % of the gradient, over a step a tenth of the gradient's own. Fails if the interpolation is linear (a kink at faces).
TEST(SolidNoise, IsSmooth) {
  const SolidNoise noise(parameters(NoisePattern::clouds, 1));
  for (std::uint64_t i = 0; i < 200; ++i) {
    Vec3d point = random_point(i);
    if (i % 2 == 0) point.x = 4 * std::round(point.x / 4);  // on a face
    const Vec3d gradient = noise.gradient(point, 0, 1), step{4e-3, 2e-3, -3e-3};
    const double ahead = double(noise.at(point + step, 0)[1]), behind = double(noise.at(point - step, 0)[1]);
    EXPECT_NEAR(ahead - behind, 2 * dot(gradient, step), .02 * 2 * length(gradient) * length(step) + 2e-6);
  }
}

// Claim: the gradient of heights on an offset is that of the heights. Tolerance: 1e-9 of it. Fails if it is a difference of
// rounded values.
TEST(SolidNoise, GradientsKeepSmallHeights) {
  NoiseParameters heights = parameters(NoisePattern::clouds, 12), raised = heights;
  heights.low = {0, 0, 0};
  heights.high = {1, 1, 1};
  raised.low = {1e6, 1e6, 1e6};
  raised.high = {1e6 + 1, 1e6 + 1, 1e6 + 1};
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Vec3d own = SolidNoise(heights).gradient(random_point(i), 1e-6, 0),
                other = SolidNoise(raised).gradient(random_point(i), 1e-6, 0);
    EXPECT_LE(length(own - other), 1e-9 * length(own));
  }
}

// Claim: seeds and octaves give other patterns, positions that are not finite finite values, and equal ends a constant.
TEST(SolidNoise, Extremes) {
  NoiseParameters one = parameters(NoisePattern::veins), other = one;
  other.seed = 4;
  const SolidNoise noise(one), reseeded(other);
  EXPECT_NE(noise.hash(), reseeded.hash());
  double difference = 0;
  for (std::uint64_t i = 0; i < 100; ++i)
    difference += std::abs(double(noise.at(random_point(i), 0)[1] - reseeded.at(random_point(i), 0)[1]));
  EXPECT_GT(difference, 10);
  for (const double x : {1e300, -1e300, 1e15, std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::quiet_NaN()})
    for (const double width : {0., 1., 1e300, std::numeric_limits<double>::infinity()})
      EXPECT_TRUE(std::isfinite(noise.at({x, 0, x}, width)[1])) << x << ' ' << width;
  EXPECT_EQ(SolidNoise::shared(one), SolidNoise::shared(one));
  EXPECT_NE(SolidNoise::shared(one), SolidNoise::shared(other));
  one.low = one.high;
  EXPECT_TRUE(SolidNoise(one).constant());
  EXPECT_FALSE(noise.constant());
}

}  // namespace
}  // namespace opaline
