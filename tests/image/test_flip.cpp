// SPDX-License-Identifier: GPL-3.0-or-later
// FLIP against the program of its authors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "layers.h"
#include "opaline/compare.h"

namespace opaline {
namespace {

constexpr int kWidth = 64, kHeight = 48;

Layer waves(double phase) {
  return make_layer(kWidth, kHeight, [&](int x, int y, int c) {
    const double angles[3] = {.31 * x + .17 * y + phase, .23 * x - .41 * y + 1.3 * phase + 1,
                              .11 * x + .53 * y + .7 * phase + 2};
    return .5 + .5 * std::sin(angles[c]);
  });
}

Layer blocks(double p) {
  return make_layer(kWidth, kHeight, [&](int x, int y, int c) {
    const double values[3] = {(x / 7 + y / 5) % 2 * (.9 - p) + .05, x / 11 % 2 * .6 + .1 + p,
                              y / 9 % 3 * .3 + .2 * p};
    return values[c];
  });
}

Layer edge(int shift) {
  return make_layer(kWidth, kHeight,
                    [&](int x, int, int c) { return (x >= 31 + shift ? .8 : .1) / (1 << c); });
}

Layer uniform(double value) {
  return make_layer(kWidth, kHeight, [&](int, int, int) { return value; });
}

double mean_of_map(const std::vector<float>& map) {
  return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

float largest_of(const std::vector<float>& map) {
  return *std::ranges::max_element(map);
}

// Claim: the map's mean and three of its pixels (two of them corners) are those of the authors' program.
// Source of the figures: flip-evaluator 1.7 of PyPI, evaluate(reference, test, "LDR", {"ppd": ...}), given
// these formulas through the sRGB curve as float32. Tolerance: 5e-5; its matrices are rounded otherwise, and
// the worst here is 2.0e-5. Fails if: a channel's filter is left out, the border is black, the features'
// kernels are not normalized, or the Hunt factor, an exponent or the knee is another.
TEST(Flip, IsTheAuthors) {
  constexpr double coarse = 30;
  const struct {
    const char* name;
    Layer picture, reference;
    double pixels_per_degree, mean, corner, middle, far_corner;
  } cases[] = {
      {"waves", waves(.15), waves(0), flip_pixels_per_degree, .3035223, .2823628, .3876837, .2684028},
      {"waves", waves(.15), waves(0), coarse, .3277125, .2831246, .4317038, .2563876},
      {"blocks", blocks(.1), blocks(0), flip_pixels_per_degree, .3902923, .5472355, .4103851, .3534956},
      {"blocks", blocks(.1), blocks(0), coarse, .4080858, .4952755, .4642665, .3534408},
      {"edge", edge(1), edge(0), flip_pixels_per_degree, .0496610, 0, .5284917, 0},
      {"edge", edge(1), edge(0), coarse, .0390963, 0, .5273330, 0},
      {"white", uniform(1), uniform(0), flip_pixels_per_degree, .9673883, .9673883, .9673883, .9673883},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name + std::string(" at ") + std::to_string(c.pixels_per_degree));
    const std::vector<float> map = flip(c.picture, c.reference, 0, c.pixels_per_degree);
    ASSERT_EQ(map.size(), std::size_t(kWidth * kHeight));
    EXPECT_NEAR(mean_of_map(map), c.mean, 5e-5);
    EXPECT_NEAR(map.front(), c.corner, 5e-5);
    EXPECT_NEAR(map[20 * kWidth + 30], c.middle, 5e-5);
    EXPECT_NEAR(map.back(), c.far_corner, 5e-5);
  }
}

// Claim: 0 for the same picture, the same in both directions, and never more than 1.
// Source: Andersson et al. 2020, section 4. Fails if: the reference alone is filtered.
TEST(Flip, IsSymmetricAndZeroOnItself) {
  const Layer a = blocks(.1), b = waves(0);
  const std::vector<float> same = flip(a, a, 0), forth = flip(a, b, 0), back = flip(b, a, 0);
  EXPECT_EQ(largest_of(same), 0.0f);
  EXPECT_EQ(forth, back);
  EXPECT_GT(*std::ranges::min_element(forth), 0.0f);
  EXPECT_LE(largest_of(forth), 1.0f);
}

// Claim: the exposure multiplies by a power of two before the cut to [0, 1]; what is beyond white is white.
// Source: compare.h. Fails if: the cut comes first, or the exposure is a factor.
TEST(Flip, ExposesAndCuts) {
  const auto times = [](const Layer& layer, float factor) {
    Layer scaled = layer;
    for (std::vector<float>& channel : scaled.channels)
      for (float& value : channel) value *= factor;
    return scaled;
  };
  EXPECT_EQ(flip(times(blocks(.1), 4), times(waves(0), 4), -2), flip(blocks(.1), waves(0), 0));
  EXPECT_EQ(largest_of(flip(uniform(7), uniform(3), 0)), 0.0f);
}

// Claim: a pixel that is not finite is black and spoils no other; the map stays finite at any exposure.
// Source: compare.h. Fails if: NaN goes into the filters (it would spread 21 pixels wide).
TEST(Flip, NonFiniteIsBlack) {
  Layer broken = waves(0), black = waves(0);
  broken.channels[0][70] = std::nanf("");
  broken.channels[1][70] = std::numeric_limits<float>::infinity();
  black.channels[0][70] = black.channels[1][70] = 0;
  EXPECT_EQ(flip(broken, waves(0), 0), flip(black, waves(0), 0));
  for (const float value : flip(broken, waves(0), 1000)) ASSERT_TRUE(std::isfinite(value));
}

// Claim: the exposure of a reference whose brightest channel has its p99 at 1/8 is 3 stops; fireflies, pixels
// off the object and a black picture do not count. Source: compare.h. Fails if: the maximum stands for the p99.
TEST(Flip, DisplayExposure) {
  Layer layer = make_layer(kWidth, kHeight, [](int, int, int c) { return .125 / (1 << c); });
  std::vector<std::uint8_t> object = everywhere(layer);
  EXPECT_DOUBLE_EQ(display_exposure(layer, object), 3);
  for (std::size_t i = 0; i < 30; ++i) layer.channels[2][i] = 1000;  // 30 of 3072
  layer.channels[1][100] = std::numeric_limits<float>::infinity();
  EXPECT_DOUBLE_EQ(display_exposure(layer, object), 3);
  for (std::size_t i = 0; i < 500; ++i) {
    layer.channels[0][i] = 1000;
    object[i] = 0;
  }
  EXPECT_DOUBLE_EQ(display_exposure(layer, object), 3);
  EXPECT_EQ(display_exposure(uniform(0), everywhere(layer)), 0);
}

// Claim: one pixel, and pictures narrower than the filters, are fine.
// Source: compare.h (the border goes on). Fails if: a filter reads beyond the border's pixels.
TEST(Flip, TinyPictures) {
  for (const auto& size : {std::pair{1, 1}, std::pair{1, 40}, std::pair{5, 3}}) {
    const auto plain = [&](double value) {
      return make_layer(size.first, size.second, [=](int, int, int) { return value; });
    };
    for (const float value : flip(plain(1), plain(0), 0)) EXPECT_NEAR(value, .9673883, 5e-5);
  }
}

}  // namespace
}  // namespace opaline
