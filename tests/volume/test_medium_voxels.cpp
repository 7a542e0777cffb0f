// SPDX-License-Identifier: GPL-3.0-or-later
// Layers for random walks, below cubes larger than they are.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "volume/medium_voxels.h"

namespace opaline::test {
namespace {

/// Mean of three layers below the plane z = 0 over the depths of a cube.
std::array<HomogeneousMedium, 3> layers_below(const Vec3d& position, double width,
                                              const std::vector<std::array<HomogeneousMedium, 3>>& layers) {
  constexpr std::array kBottoms{.1, .25, 1e9};
  const double first = std::max(0., -position.z - .5 * width),
               last = std::max(first, -position.z + .5 * width) + 1e-9;
  std::array<HomogeneousMedium, 3> mean{};
  double top = 0;
  for (std::size_t i = 0; i < kBottoms.size(); ++i) {
    const double share = std::max(0., std::min(last, kBottoms[i]) - std::max(first, top)) / (last - first);
    for (std::size_t c = 0; c < 3; ++c) {
      mean[c].sigma_a += share * layers[i][c].sigma_a;
      mean[c].sigma_s += share * layers[i][c].sigma_s;
    }
    top = kBottoms[i];
  }
  return mean;
}

// Claim: a position has the medium of its layer, however large the cubes; the densest medium is the densest layer. Source:
// definition. Tolerance: 1e-3, but for positions at faces. Fails if: cubes hold the mean of their layers, so that
// dark skin is too bright.
TEST(MediumVoxels, LayersThinnerThanCubes) {
  std::vector<std::array<HomogeneousMedium, 3>> layers(3);
  for (std::size_t c = 0; c < 3; ++c) {
    layers[0][c] = {double(20 + c), 5, 0, 1.4};
    layers[1][c] = {.1, 4, 0, 1.4};
    layers[2][c] = {.01, 1, 0, 1.4};
  }
  const MediaInside media = [&](const Vec3d& at, double width) { return layers_below(at, width, layers); };
  const MediumVoxels voxels(media, {{-10, -10, -20}, {10, 10, 0}}, 1, layers);
  const auto expect = [&](double depth, std::size_t layer) {
    for (std::size_t c = 0; c < 3; ++c) {
      const MediumVoxels::Local found = voxels.at({.3, -4.2, -depth}, c);
      EXPECT_NEAR(double(found.sigma_t) / layers[layer][c].sigma_t(), 1, 1e-3) << depth << ' ' << c;
      EXPECT_NEAR(double(found.albedo), layers[layer][c].albedo(), 1e-3) << depth << ' ' << c;
    }
  };
  for (const double depth : {.01, .05, .09}) expect(depth, 0);
  for (const double depth : {.11, .2, .24}) expect(depth, 1);
  for (const double depth : {.26, .9, 1.5, 7., 19.9}) expect(depth, 2);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(voxels.densest(c).sigma_t(), layers[0][c].sigma_t(), 1e-5);
}

}  // namespace
}  // namespace opaline::test
