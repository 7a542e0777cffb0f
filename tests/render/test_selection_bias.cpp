// SPDX-License-Identifier: GPL-3.0-or-later
// The bias of near fields that are refined where noise asks for it.
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "methods/hierarchical/near_field/selection_bias.h"

namespace opaline {
namespace {

// Claim: where only noise tells points apart, and those whose irradiance is high by chance are refined to the
// true mean, the bias told is that of the mean of all. Source: the same points without refinement, whose mean
// is right. Tolerance: 15 %: windows of 16 take 1/16 off a covariance, and their spread
// differs by chance. Fails if: the sign
// is wrong, or refined points count as noisy.
TEST(SelectionBias, OfPointsThatNoiseChose) {
  constexpr std::size_t kPoints = 160000;
  constexpr float kShare = .5f, kNear = .4f, kBright = 4;
  std::vector<RgbF> own(kPoints);
  std::vector<Rgb> noise(kPoints);
  std::vector<Exitance> exitance(kPoints);
  std::vector<std::uint32_t> refined;
  double bias = 0;
  const float scale = kShare * kNear;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    // One ray in four arrives: irradiance 1 on the whole.
    const bool lit = unit_double(hash_bits(7, i)) < .25;
    own[i] = RgbF(lit ? kBright : 0.0f);
    noise[i] = Rgb(double(scale * scale * 3));
    exitance[i].irradiance = RgbF(1);
    exitance[i].near = RgbF(kNear);
    if (lit) refined.push_back(i);
    if (!lit) bias += double(scale) * (0 - 1);
  }
  bias /= double(kPoints);
  const std::vector<RgbF> told = selection_bias({{kShare, kShare, kShare}, own, exitance, noise, refined});
  double mean = 0;
  for (const RgbF& b : told) mean += double(b.x) / double(kPoints);
  EXPECT_NEAR(mean, bias, .15 * std::abs(bias));
}

// Claim: a shadow's edge in the light of a free point source has no noise and no such bias.
TEST(SelectionBias, NoneWithoutNoise) {
  std::vector<RgbF> own(32);
  std::vector<Rgb> noise(32);
  std::vector<Exitance> exitance(32);
  for (std::size_t i = 0; i < 32; ++i) {
    own[i] = RgbF(i < 10 ? 1.0f : 0.0f);
    exitance[i].irradiance = RgbF(.5f);
    exitance[i].near = RgbF(1);
  }
  const std::vector<std::uint32_t> refined{8, 9};
  for (const RgbF& b : selection_bias({{.5f, .5f, .5f}, own, exitance, noise, refined})) EXPECT_EQ(b, RgbF{});
}

}  // namespace
}  // namespace opaline
