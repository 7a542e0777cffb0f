// SPDX-License-Identifier: GPL-3.0-or-later
// Relative errors against values computed by hand, and the estimate from halves against its expectation.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "image/error_picture.h"
#include "layers.h"
#include "opaline/compare.h"

namespace opaline {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
const float nan_value = std::nanf("");

Layer grey(int width, int height, double value) {
  return make_layer(width, height, [=](int, int, int) { return value; });
}

Layer one_channel(std::vector<float> values) {
  return {static_cast<int>(values.size()), 1, {"R"}, {std::move(values)}};
}

// Claim: e = (a - b) / |b|, and its mean, mean square, p99, largest and signed mean.
// By hand: b = 2, 4, -5, 8 and a = 3, 3, -5, 10 give e = 1/2, -1/4, 0, 1/4; mean |e| = 1/4, mean e^2 =
// (1/4 + 1/16 + 1/16) / 4 = 3/32, mean e = 1/8; the largest and, of four values, the p99 are 1/2. Tolerance:
// rounding of doubles. Fails if: the quotient is by a, by b with its sign, or the mean square by 3.
TEST(Metrics, ByHand) {
  const Layer a = one_channel({3, 3, -5, 10}), b = one_channel({2, 4, -5, 8});
  const RelativeErrors errors = relative_errors(a, b, everywhere(a));
  EXPECT_EQ(errors.channels[0], (std::vector<double>{.5, -.25, 0, .25}));
  EXPECT_DOUBLE_EQ(errors.floors[0], 8e-3);
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.values, 4u);
  EXPECT_DOUBLE_EQ(s.mean, .25);
  EXPECT_DOUBLE_EQ(s.mean_square, 3.0 / 32);
  EXPECT_DOUBLE_EQ(s.signed_mean, .125);
  EXPECT_DOUBLE_EQ(s.p99, .5);
  EXPECT_DOUBLE_EQ(s.largest, .5);
}

// Claim: the p99 is the value of nearest rank: of 1 ... n it is ceil(.99 n).
// Source: compare.h. Fails if: the rank is off by one (floor, or 0-based without - 1).
TEST(Metrics, PercentileIsOfNearestRank) {
  for (const int n : {1, 2, 99, 100, 101, 1000}) {
    std::vector<double> values;
    for (int i = n; i > 0; --i) values.push_back(i);
    EXPECT_EQ(percentile(values, .99), std::ceil(.99 * n)) << n;
  }
  EXPECT_EQ(percentile({}, .99), 0);
}

// Claim: where b is small, the divisor is 1e-3 of the p99 of |b| over the object: one bright pixel in 200 (a
// firefly) and pixels off the object do not raise it. By hand: 198 pixels of 10, one of 0, one of 1e6: p99 is
// 10, floor .01; a = b + .001 gives .1 at the black pixel, 1e-4 at the others (float a: rounding 1e-6 / 10),
// (198 x 1e-4 + .1 + 0) / 200 = 5.99e-4 in the mean. Fails if: the floor is of the maximum, or of all pixels.
TEST(Metrics, FloorIsOfTheP99) {
  std::vector<float> b(202, 10);
  b[0] = 0;
  b[1] = 1e6f;
  b[200] = b[201] = 5e4f;
  std::vector<float> a = b;
  for (float& value : a) value += .001f;
  const Layer picture = one_channel(a), reference = one_channel(b);
  std::vector<std::uint8_t> object = everywhere(picture);
  object[200] = object[201] = 0;
  const RelativeErrors errors = relative_errors(picture, reference, object);
  EXPECT_DOUBLE_EQ(errors.floors[0], .01);
  EXPECT_NEAR(errors.channels[0][0], .1, 1e-8);
  EXPECT_TRUE(std::isnan(errors.channels[0][200]));
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.values, 200u);
  EXPECT_NEAR(s.mean, 5.99e-4, 1e-7);
}

// Claim: a reference that is black, wholly or but for 1 % of its pixels, makes the error large and not
// infinite, whatever the unit; two black pictures do not differ. Source: compare.h. Fails if: the floor is 0.
TEST(Metrics, BlackReference) {
  for (const float unit : {1e-30f, 1.0f, 1e30f}) {
    std::vector<float> a(200, 0), b(200, 0);
    a[5] = unit;
    const ErrorStatistics black =
        error_statistics(relative_errors(one_channel(a), one_channel(b), std::vector<std::uint8_t>(200, 1)));
    EXPECT_DOUBLE_EQ(black.largest, 1000);
    b[7] = 2 * unit;
    const ErrorStatistics dot =
        error_statistics(relative_errors(one_channel(a), one_channel(b), std::vector<std::uint8_t>(200, 1)));
    EXPECT_DOUBLE_EQ(dot.largest, 500);
  }
  const Layer black = one_channel({0, 0});
  EXPECT_EQ(error_statistics(relative_errors(black, black, everywhere(black))).largest, 0);
}

// Claim: each channel has its own figures and floor; "all" takes the values of all of them as one set.
// By hand: e = .1, .2 and -.6 everywhere give means .1, .2, .6, all .3, signed -.1, mean square .41 / 3.
// Tolerance: float rounding of a. Fails if: a channel is compared with another, or one floor serves all.
TEST(Metrics, Channels) {
  const Layer b = make_layer(4, 4, [](int, int, int c) { return std::pow(100.0, c); });
  const Layer a = make_layer(4, 4, [](int, int, int c) {
    const double e[3] = {.1, .2, -.6};
    return std::pow(100.0, c) * (1 + e[c]);
  });
  const RelativeErrors errors = relative_errors(a, b, everywhere(a));
  const double means[3] = {.1, .2, .6};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(error_statistics(errors.channels[c]).mean, means[c], 1e-6);
    EXPECT_NEAR(errors.floors[c], 1e-3 * std::pow(100.0, double(c)), 1e-9);
  }
  const ErrorStatistics all = error_statistics(errors);
  EXPECT_EQ(all.values, 48u);
  EXPECT_NEAR(all.mean, .3, 1e-6);
  EXPECT_NEAR(all.signed_mean, -.1, 1e-6);
  EXPECT_NEAR(all.mean_square, .41 / 3, 1e-6);
}

// Claim: NaN and infinities are counted apart, in each picture, and enter no figure: those of the other
// channels and pixels are what they were. Source: compare.h. Fails if: an infinity in b counts as error 0
// (a - inf over inf), or a NaN in one channel takes the pixel from all.
TEST(Metrics, NonFiniteIsApart) {
  Layer a = grey(10, 10, 1.5), b = grey(10, 10, 1);
  a.channels[0][3] = nan_value;
  a.channels[0][4] = a.channels[1][4] = -kInfinity;
  b.channels[2][5] = b.channels[2][3] = kInfinity;
  EXPECT_EQ(count_non_finite(a).nan, 1u);
  EXPECT_EQ(count_non_finite(a).infinite, 2u);
  EXPECT_EQ(count_non_finite(b).nan, 0u);
  EXPECT_EQ(count_non_finite(b).infinite, 2u);
  const RelativeErrors errors = relative_errors(a, b, everywhere(a));
  const std::size_t values[3] = {98, 99, 98};
  for (std::size_t c = 0; c < 3; ++c) {
    const ErrorStatistics s = error_statistics(errors.channels[c]);
    EXPECT_EQ(s.values, values[c]);
    EXPECT_DOUBLE_EQ(s.mean, .5);
    EXPECT_DOUBLE_EQ(s.largest, .5);
  }
  EXPECT_EQ(error_statistics(errors).values, 295u);
}

// Claim: the object is where the coverage is above 0 (or NaN), everything without coverage. A layer has its
// channels in the order R, G, B whatever the file's; no layer of that name: no channels.
// Source: compare.h. Fails if: coverage .01 is dropped, or the channels are taken in the file's order.
TEST(Metrics, LayersAndObject) {
  Image image;
  image.width = 3;
  image.height = 1;
  image.channels = {"diffuse.B", "A", "diffuse.G", "diffuse.R", "Z",   "G",
                    "R",         "B", "N.X",       "N.Y",       "N.Z", "u.v"};
  image.pixels.resize(3 * image.channels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i);
  image.pixels[1] = 0;
  image.pixels[12 + 1] = .01f;
  image.pixels[24 + 1] = nan_value;
  EXPECT_EQ(object_pixels(image), (std::vector<std::uint8_t>{0, 1, 1}));

  const Layer diffuse = extract_layer(image, "diffuse");
  EXPECT_EQ(diffuse.names, (std::vector<std::string>{"diffuse.R", "diffuse.G", "diffuse.B"}));
  EXPECT_EQ(diffuse.channels, (std::vector<std::vector<float>>{{3, 15, 27}, {2, 14, 26}, {0, 12, 24}}));
  EXPECT_EQ(extract_layer(image, "").channels[0], (std::vector<float>{6, 18, 30}));
  EXPECT_EQ(extract_layer(image, "N").names[2], "N.Z");
  EXPECT_EQ(extract_layer(image, "Z").channels, (std::vector<std::vector<float>>{{4, 16, 28}}));
  EXPECT_TRUE(extract_layer(image, "specular").channels.empty());
  EXPECT_EQ(layers_of(image), (std::vector<std::string>{"R,G,B", "diffuse", "A", "Z", "N", "u.v"}));
  for (const std::string& name : layers_of(image))
    EXPECT_FALSE(extract_layer(image, name == "R,G,B" ? "" : name).channels.empty()) << name;

  image.channels = {"Y", "U", "V", "W", "1", "2", "3", "4", "5", "6", "7", "8"};
  EXPECT_EQ(object_pixels(image), (std::vector<std::uint8_t>{1, 1, 1}));
  EXPECT_TRUE(extract_layer(image, "").channels.empty());
}

// Claim: the estimate from halves is, by hand, for h = 3, 1; d1 = 2, 1; d2 = 2, 3: d = 2, 2, m = 2; terms 1 /
// 4.0004 and 0 x (-2) / 4.0004; signed (1/2 - 1/2) / 2 = 0; noise terms 0 and 2 / 4.0004. The standard error
// of two values is half their distance. Fails if: (h - d)^2 stands for the product, or m is left out.
TEST(Halves, ByHand) {
  const Layer h = one_channel({3, 1}), d1 = one_channel({2, 1}), d2 = one_channel({2, 3});
  const HalvesEstimate e = compare_with_halves(h, d1, d2, everywhere(h)).channels[0];
  EXPECT_EQ(e.pixels, 2u);
  EXPECT_DOUBLE_EQ(e.squared_error, .5 / 4.0004);
  EXPECT_DOUBLE_EQ(e.error, std::sqrt(.5 / 4.0004));
  EXPECT_DOUBLE_EQ(e.standard_error, .5 / 4.0004);
  EXPECT_DOUBLE_EQ(e.signed_mean, 0);
  EXPECT_DOUBLE_EQ(e.half_noise, std::sqrt(1 / 4.0004));
  EXPECT_EQ(mean_of(d1, d2).channels[0], (std::vector<float>{2, 2}));
}

/// d1 and d2 are 1 with noise of +-5 %, either sign as likely; h is 1 + error. The quotient's expectation is
/// then the mean over four cases, exactly.
struct NoisyHalves {
  static constexpr double noise = .05;
  Layer h, d1, d2;
  double expected = 0;

  NoisyHalves(int size, double error, unsigned seed) : h(grey(size, size, 1 + error)), d1(h), d2(h) {
    std::mt19937 random(seed);
    for (Layer* half : {&d1, &d2})
      for (std::vector<float>& channel : half->channels)
        for (float& value : channel) value = static_cast<float>(random() & 1 ? 1 + noise : 1 - noise);
    for (const double n1 : {-noise, noise})
      for (const double n2 : {-noise, noise}) {
        const double d = 1 + (n1 + n2) / 2;
        expected += (error - n1) * (error - n2) / (d * d + 1e-4 * (1 + noise) * (1 + noise)) / 4;
      }
  }
};

// Claim: with noise of 5 % a half, the estimate is the known expectation, with no error and with one of 3 %,
// within 4 standard errors (twelve figures: a false alarm in 1300 runs; the seed is fixed, so none), and the
// standard error is what five hundred repetitions spread by, within 15 % (its own deviation is 3.2 %). The
// noise would add noise^2 / 2 = 1.25e-3 to (h - d)^2: 40 standard errors and more. Source: compare.h. Fails
// if: d^2 or |product| stands for the product, or the standard error is not divided by sqrt(n).
TEST(Halves, NoiseDoesNotRaiseTheEstimate) {
  for (const double error : {0.0, .03}) {
    const NoisyHalves big(256, error, 7);
    const HalvesComparison result = compare_with_halves(big.h, big.d1, big.d2, everywhere(big.h));
    for (const HalvesEstimate& e : result.channels) {
      EXPECT_NEAR(e.squared_error, big.expected, 4 * e.standard_error);
      EXPECT_GT(NoisyHalves::noise * NoisyHalves::noise / 2, 40 * e.standard_error);
      EXPECT_NEAR(e.half_noise, NoisyHalves::noise, .01 * NoisyHalves::noise);
      EXPECT_NEAR(e.signed_mean, error, 4 * NoisyHalves::noise / std::sqrt(2.0) / 256);
    }
    EXPECT_NEAR(result.all.squared_error, big.expected, 4 * result.all.standard_error);
  }

  double sum = 0, squares = 0, stated = 0;
  constexpr int repetitions = 500;
  for (int i = 0; i < repetitions; ++i) {
    const NoisyHalves small(16, .03, static_cast<unsigned>(i));
    const HalvesEstimate e =
        compare_with_halves(small.h, small.d1, small.d2, everywhere(small.h)).channels[0];
    sum += e.squared_error;
    squares += e.squared_error * e.squared_error;
    stated += e.standard_error / repetitions;
  }
  const double mean = sum / repetitions;
  EXPECT_NEAR(stated / std::sqrt(squares / repetitions - mean * mean), 1, .15);
}

// Claim: what the quotient keeps of Gaussian noise n is 1.5 n^4 where there is no error, as compare.h says:
// at n = 10 % 1.5e-4, within a quarter (higher orders: 10 n^2) and 4 standard errors (7e-6 each).
// Fails if: the remark in compare.h is wrong.
TEST(Halves, WhatTheQuotientKeeps) {
  constexpr double n = .1;
  std::mt19937 random(3);
  std::normal_distribution<float> noise(1, n);
  const auto noisy = [&] { return make_layer(512, 512, [&](int, int, int) { return noise(random); }); };
  const Layer d1 = noisy(), d2 = noisy(), h = grey(512, 512, 1);
  const HalvesEstimate all = compare_with_halves(h, d1, d2, everywhere(h)).all;
  EXPECT_NEAR(all.squared_error, 1.5 * n * n * n * n, .4e-4 + 4 * all.standard_error);
  EXPECT_GT(all.squared_error, 4 * all.standard_error);
}

// Claim: a picture that is one of the halves' own mean is below noise: negative, with its value.
// By hand: h = d = 1, d1 = .9, d2 = 1.1: -.01 / 1.0001. Fails if: the sign is lost in the root.
TEST(Halves, BelowNoise) {
  const Layer d1 = grey(4, 4, .9), d2 = grey(4, 4, 1.1), h = grey(4, 4, 1);
  const HalvesEstimate all = compare_with_halves(h, d1, d2, everywhere(h)).all;
  EXPECT_NEAR(all.squared_error, -.01 / 1.0001, 1e-7);
  EXPECT_NEAR(all.error, -.1, 1e-4);
}

// Claim: a value that is not finite in any of the three takes its channel's pixel out, and no more; black
// halves give a large error, no infinity. Source: compare.h. Fails if: d1 alone is looked at.
TEST(Halves, NonFiniteAndBlack) {
  Layer h = grey(4, 4, 1.1), d1 = grey(4, 4, 1), d2 = d1;
  h.channels[0][0] = nan_value;
  d1.channels[0][1] = kInfinity;
  d2.channels[0][2] = nan_value;
  const HalvesComparison result = compare_with_halves(h, d1, d2, everywhere(h));
  EXPECT_EQ(result.channels[0].pixels, 13u);
  EXPECT_EQ(result.channels[1].pixels, 16u);
  for (const HalvesEstimate& e : result.channels) EXPECT_NEAR(e.squared_error, .01 / 1.0001, 1e-7);
  EXPECT_NEAR(result.all.squared_error, .01 / 1.0001, 1e-7);

  const Layer black = grey(4, 4, 0);
  const HalvesEstimate dark = compare_with_halves(grey(4, 4, 2), black, black, everywhere(black)).all;
  EXPECT_DOUBLE_EQ(dark.error, 100);
  EXPECT_DOUBLE_EQ(dark.signed_mean, 1);
  EXPECT_EQ(compare_with_halves(black, black, black, everywhere(black)).all.error, 0);
}

// Claim: a greater error is a brighter colour (luminance of the linear values), by steps of no less than a
// third and no more than three times the mean in CIELAB lightness; the ends are black and white.
// Source: error_picture.h. Fails if: hue 4 stands for 1.6, colours are cut, and brightness falls on the way.
TEST(ErrorPicture, BrighterIsWorse) {
  const auto lightness = [](double place) {
    const RgbF c = brightness_ordered_colour(place);
    const auto linear = [](double v) { return v <= .04045 ? v / 12.92 : std::pow((v + .055) / 1.055, 2.4); };
    const double y = .2126 * linear(c.x) + .7152 * linear(c.y) + .0722 * linear(c.z);
    return y > .008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
  };
  EXPECT_EQ(brightness_ordered_colour(-1), RgbF(0.0f));
  EXPECT_EQ(brightness_ordered_colour(2), RgbF(1.0f));
  constexpr int steps = 40;
  for (int i = 0; i < steps; ++i) {
    const double step = lightness((i + 1.0) / steps) - lightness(double(i) / steps);
    EXPECT_GT(step, 100.0 / steps / 3) << i;
    EXPECT_LT(step, 100.0 / steps * 3) << i;
  }
}

// Claim: the pictures show each pixel's error: 1 % (the largest channel) the middle of the scale, no object
// grey, not finite green; the signed one holds the values. Source: error_picture.h. Tolerance: float
// rounding. Fails if: the mean over the channels is shown, or a NaN passes for no error.
TEST(ErrorPicture, ShowsTheErrors) {
  Layer b = grey(4, 1, 1), a = b;
  a.channels[1][0] = .99f;
  a.channels[2][1] = nan_value;
  a.channels[0][2] = 9;
  a.names = {"diffuse.R", "diffuse.G", "diffuse.B"};
  const std::vector<std::uint8_t> object{1, 1, 0, 1};
  const RelativeErrors errors = relative_errors(a, b, object);
  const Image shown = error_colours(errors, a, object);
  const auto pixel = [&](std::size_t i) {
    return RgbF{shown.pixels[3 * i], shown.pixels[3 * i + 1], shown.pixels[3 * i + 2]};
  };
  const RgbF middle = brightness_ordered_colour(.5);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(pixel(0)[c], std::pow((middle[c] + .055) / 1.055, 2.4), 1e-4);
  EXPECT_EQ(pixel(1), RgbF(0, 1, 0));
  EXPECT_TRUE(pixel(2).x == pixel(2).y && pixel(2).y == pixel(2).z && pixel(2).x > 0);
  EXPECT_EQ(pixel(3), RgbF(0.0f));

  const Image values = signed_errors(errors, a);
  EXPECT_EQ(values.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_NEAR(values.pixels[1], -.01, 1e-6);
  EXPECT_EQ(values.pixels[5], 0);
  EXPECT_EQ(values.pixels[6], 0);
}

// Claim: all measures divide by the reference. By hand: the left half of the picture has half of the reference's light,
// which is an error of 0.5 there and of sqrt(0.5^2 / 2) = 0.35355 in the whole; three times the light on the right makes it
// sqrt((0.5^2 + 2^2) / 2) = 1.45774. Tolerance: the floor (0.01 m)^2, a part of 1e-4. Fails if: the tested picture stands in
// a divisor (0.70711 and 0.84984).
TEST(Metrics, AllMeasuresAreRelativeToTheReference) {
  const Layer reference = grey(20, 20, 2), no_noise = grey(20, 20, 0);
  const std::vector<std::uint8_t> all = everywhere(reference);
  for (const auto& [right, error] : {std::pair{2., .35355}, std::pair{6., 1.45774}}) {
    const Layer picture = make_layer(20, 20, [right = right](int x, int, int) { return x < 10 ? 1 : right; });
    EXPECT_NEAR(std::sqrt(error_statistics(relative_errors(picture, reference, all)).mean_square), error,
                1e-4);
    EXPECT_NEAR(compare_with_halves(picture, reference, reference, all).all.error, error, 1e-4);
    EXPECT_NEAR(error_beyond_noise(picture, reference, no_noise, all), error, 1e-4);
  }
}

// Claim: error_beyond_noise is the error, not the noise of the reference: a picture that is 5 % too bright has an error of
// 0.05 against a reference with 20 % noise a pixel, and a right one less than 0.035. Source: the expectation of (h - d)^2 is
// error^2 + v. Tolerance: four standard errors; over 40,000 pixels the noise's square is known to .2^2 sqrt(2 / 40,000) =
// 2.8e-4. Fails if: the variance is not taken out (.2), or a pixel's own noise stands in its divisor (.1 for the right
// picture).
TEST(Metrics, ErrorBeyondTheNoiseOfAReference) {
  constexpr double kNoise = .2;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Layer reference = make_layer(200, 200, [&](int, int, int) { return 1 + kNoise * normal(random); });
  const Layer variance = grey(200, 200, kNoise * kNoise);
  const std::vector<std::uint8_t> all = everywhere(reference);
  EXPECT_NEAR(error_beyond_noise(grey(200, 200, 1.05), reference, variance, all), .05, .013);
  EXPECT_LT(error_beyond_noise(grey(200, 200, 1), reference, variance, all), .035);
  EXPECT_NEAR(error_beyond_noise(grey(200, 200, 1.5), reference, variance, all), .5, .005);
}

}  // namespace
}  // namespace opaline
