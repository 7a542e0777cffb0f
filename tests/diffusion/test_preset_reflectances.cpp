// SPDX-License-Identifier: GPL-3.0-or-later
// Twelve measured materials and the diffuse reflectances printed beside them.
#include <algorithm>
#include <map>
#include <string>

#include "diffusion/diffusion_test.h"
#include "input/presets.h"

namespace opaline {
namespace {

using namespace test;

const std::map<std::string, Rgb> kPrintedReflectances = {
    {"apple", {.85, .84, .53}},    {"potato", {.77, .62, .21}},   {"chicken1", {.31, .15, .10}},
    {"skimmilk", {.81, .81, .69}}, {"chicken2", {.32, .16, .10}}, {"skin1", {.44, .22, .13}},
    {"cream", {.98, .90, .73}},    {"skin2", {.63, .44, .34}},    {"ketchup", {.16, .01, .00}},
    {"spectralon", {1., 1., 1.}},  {"marble", {.83, .79, .75}},   {"wholemilk", {.91, .88, .76}}};

// Claim: the dipole's total, as it is, reproduces 35 of the 36 printed reflectances within .01; the outlier
// is chicken1 blue (.126). The printed ones are the total itself: times 1 - F(0) or 1 - F_bar far fewer
// agree. Source: Jensen et al. 2001, figure 5. Tolerance: .01 plus half the printed digit. Fails if: one
// preset's digit is wrong (potato blue .12 -> .012), or eta is 1.3 for marble.
TEST(PresetReflectances, Printed) {
  ASSERT_EQ(measured_presets().size(), kPrintedReflectances.size());
  int close = 0, close_at_normal = 0, close_at_diffuse = 0;
  double sum = 0;
  for (const Preset& preset : measured_presets()) {
    ASSERT_TRUE(kPrintedReflectances.count(std::string(preset.name))) << preset.name;
    const Rgb printed = kPrintedReflectances.at(std::string(preset.name));
    const DiffuseProfile profile =
        make_diffuse_profile({"preset", preset.coefficients, preset.eta, ProfileKind::dipole});
    EXPECT_EQ(profile.eta, preset.name == "marble" ? 1.5 : 1.3);
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = std::abs(profile.total[c] - printed[c]);
      sum += error;
      close += error <= .01;
      const bool outlier = preset.name == "chicken1" && c == 2;
      EXPECT_EQ(error > .015, outlier) << preset.name << " " << c << ": " << profile.total[c];
      const double normal = 1 - fresnel_reflectance(1.0, preset.eta),
                   diffuse = 1 - profile.average_reflectance;
      close_at_normal += std::abs(profile.total[c] * normal - printed[c]) <= .01;
      close_at_diffuse += std::abs(profile.total[c] * diffuse - printed[c]) <= .01;
    }
  }
  std::printf("             within .01: total %d, x (1 - F(0)) %d, x (1 - F_bar) %d; mean error %.4f\n",
              close, close_at_normal, close_at_diffuse, sum / 36);
  EXPECT_EQ(close, 35);
  EXPECT_LT(sum / 36, .005);
  EXPECT_LT(std::max(close_at_normal, close_at_diffuse), 25);
}

}  // namespace
}  // namespace opaline
