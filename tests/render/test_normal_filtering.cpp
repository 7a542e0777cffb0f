// SPDX-License-Identifier: GPL-3.0-or-later
// Normal maps seen from afar.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "support/pictures.h"
#include "support/scene_picture.h"

namespace opaline::test {
namespace {

constexpr int kTexels = 1024, kFacet = 8, kFar = 8;

// Facets of 8 x 8 texels with Gaussian slopes.
void put_facets(const std::string& path, double deviation) {
  put_exr(path, kTexels, kTexels, [&](int x, int y) {
    const auto facet = std::uint64_t(x / kFacet + y / kFacet * kTexels);
    const double radius = deviation * std::sqrt(-2 * std::log(1 - unit_double(hash_bits(1, 2 * facet)))),
                 angle = 6.283185307179586 * unit_double(hash_bits(1, 2 * facet + 1));
    const double slope_x = radius * std::cos(angle), slope_y = radius * std::sin(angle),
                 length = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
    return std::array<double, 3>{.5 + .5 * slope_x / length, .5 + .5 * slope_y / length, .5 + .5 / length};
  });
}

// Heights whose slopes are Gaussian: waves of 8 to 16 texels in all directions. Returns the key of the map.
std::string put_waves(const std::string& path, double deviation) {
  constexpr int kWaves = 48, kSide = 512;
  constexpr double kTexel = 20. / kSide;  // mm
  struct Wave {
    double x, y, phase;
  };
  std::vector<Wave> waves;
  double squares = 0;  // sum of both axes' mean squared slopes, of waves of 1 mm
  for (std::uint64_t i = 0; i < kWaves; ++i) {
    // Whole periods in the image, which is repeated.
    const double periods = kSide / (8 + 8 * unit_double(hash_bits(2, 3 * i))),
                 angle = 6.283185307179586 * unit_double(hash_bits(2, 3 * i + 1));
    waves.push_back({std::round(periods * std::cos(angle)), std::round(periods * std::sin(angle)),
                     6.283185307179586 * unit_double(hash_bits(2, 3 * i + 2))});
    const double k = 6.283185307179586 * std::hypot(waves.back().x, waves.back().y) / (kSide * kTexel);
    squares += k * k / 2;
  }
  put_exr(path, kSide, kSide, [&](int x, int y) {
    double sum = 0;
    for (const Wave& wave : waves)
      sum += std::cos(6.283185307179586 * (wave.x * x + wave.y * y) / kSide + wave.phase);
    return std::array<double, 3>{.5 + .5 * sum / kWaves, 0, 0};
  });
  const double amplitude = deviation / std::sqrt(squares / 2);
  return R"("bump_map": {"texture": "waves.exr", "scale": )" + std::to_string(2 * kWaves * amplitude) + "}";
}

// Specular green of a metal sheet under a lamp, in blocks of kFar x kFar.
std::vector<double> highlights(const ScratchFolder& folder, int pixels, const std::string& roughness,
                               const std::string& map = R"("normal_map": {"texture": "facets.exr"})") {
  const Image image = picture_of(folder, R"({
    "shapes": [{"quad": {"corner": [-10, -10, 0], "u": [20, 0, 0], "v": [0, 20, 0]}, "reflectance": 0.9,
                "metalness": 1, "specular_roughness": )" +
                                             roughness + ", " + map + R"(}],
    "lights": [{"type": "point", "position": [6, 10, 30], "intensity": 1000}],
    "camera": {"position": [0, 0, 60], "look_at": [0, 0, 0], "field_of_view": 18},
    "settings": {"bounces": 0}, "film": {"pixel_type": "float",
    "resolution": [)" + std::to_string(pixels) +
                                             ", " + std::to_string(pixels) + "]}}");
  const auto green = std::size_t(std::ranges::find(image.channels, "specular.G") - image.channels.begin());
  const int block = pixels / kFar;
  std::vector<double> blocks(kFar * kFar);
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x)
      blocks[std::size_t(y / block * kFar + x / block)] +=
          double(image.pixels[std::size_t(y * pixels + x) * image.channels.size() + green]) / (block * block);
  return blocks;
}

void expect_alike(const std::vector<double>& far, const std::vector<double>& near, double of_sum,
                  double of_mean) {
  double sum = 0, of_far = 0, off = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    sum += near[i];
    of_far += far[i];
    off += std::abs(far[i] - near[i]);
  }
  EXPECT_NEAR(of_far / sum, 1, of_sum);
  EXPECT_LT(off / sum, of_mean);
}

// Claim: a far image of facets is its near image, scaled down. Source: 64 texels a facet, 256 facets a far pixel, Gaussian slopes of
// .2 under an alpha of .12. Tolerance: 3 % in the sum; 12 % in the mean of the pixels' differences, as about 40 facets of a pixel
// reflect the lamp. Fails if: the slopes' variance does not widen the lobe (sum 1.70, mean difference 114 %), or is counted once
// (1.22, 34 %).
TEST(NormalFiltering, FarIsNearScaledDown) {
  const ScratchFolder folder;
  put_facets(folder.file("facets.exr"), .2);
  const std::vector<double> near = highlights(folder, 2048, "0.35"), far = highlights(folder, kFar, "0.35");
  expect_alike(far, near, .03, .12);
}

// Claim: so is a far image of heights. Source: Gaussian slopes of .2 under an alpha of .12, 28 waves a far pixel. Tolerance: 5 % in
// the sum; 20 % in the mean of the pixels' differences. Fails if: the variance of slopes is left out (sum 1.79, 119 %).
TEST(NormalFiltering, FarHeightsAreNearOnesScaledDown) {
  const ScratchFolder folder;
  const std::string map = put_waves(folder.file("waves.exr"), .2);
  const std::vector<double> near = highlights(folder, 512, "0.35", map),
                            far = highlights(folder, kFar, "0.35", map);
  expect_alike(far, near, .05, .2);
}

}  // namespace
}  // namespace opaline::test
