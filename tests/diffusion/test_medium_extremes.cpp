// SPDX-License-Identifier: GPL-3.0-or-later
// Media at their limits.
#include <bit>

#include "diffusion/diffusion_test.h"

namespace opaline {
namespace {

using namespace test;

bool all_finite(const DiffuseProfile& profile) {
  bool good = is_finite(profile.total) && is_finite(profile.mean_free_path);
  for (const ChannelProfile& channel : profile.channels)
    for (const double r : {1e-30, 1e-6, 1., 1e6, 1e30})
      good = good && std::isfinite(diffuse_reflectance_profile(channel, r)) &&
             std::isfinite(diffuse_reflectance_within(channel, r)) &&
             std::isfinite(near_field_reflectance(channel, std::min(r, 1e9)));
  return good;
}

// Claim: where nothing scatters the diffuse part is exactly 0: no profile, total, running or near-field
// integral. Source: the contract. Tolerance: none. Fails if: alpha' = 0 makes a dipole of strength 0 times
// infinity.
TEST(MediumExtremes, NothingScatters) {
  for (const ProfileKind kind : kAllProfiles) {
    const DiffuseProfile profile = make_diffuse_profile(medium_of(Rgb(.5), Rgb(0), 1.3, kind));
    EXPECT_FALSE(profile.translucent);
    EXPECT_EQ(profile.total, Rgb(0));
    for (const ChannelProfile& channel : profile.channels) {
      EXPECT_TRUE(std::holds_alternative<std::monostate>(channel));
      EXPECT_EQ(diffuse_reflectance_profile(channel, 0), 0);
      EXPECT_EQ(diffuse_reflectance_profile(channel, 1), 0);
      EXPECT_EQ(diffuse_reflectance_within(channel, 1), 0);
      EXPECT_EQ(total_diffuse_reflectance(channel), 0);
      EXPECT_EQ(near_field_reflectance(channel, 1), 0);
    }
  }
}

// Claim: a medium that neither scatters nor absorbs is not translucent; its mean free path reads 0, not
// infinity. Source: the contract. Tolerance: none. Fails if: 1/sigma_t' is divided out.
TEST(MediumExtremes, Nothing) {
  const DiffuseProfile profile = make_diffuse_profile(medium_of(Rgb(0), Rgb(0), 1.3));
  EXPECT_FALSE(profile.translucent);
  EXPECT_EQ(profile.total, Rgb(0));
  EXPECT_EQ(profile.mean_free_path, Rgb(0));
  EXPECT_TRUE(all_finite(profile));
}

// Claim: one channel without any coefficient leaves every bit of the others. Source: a peer's one empty
// channel made every pixel NaN. Tolerance: none. Fails if: anything is shared across channels, a smallest
// mean free path say.
TEST(MediumExtremes, OneEmptyChannel) {
  const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v); };
  for (const ProfileKind kind : kAllProfiles) {
    const Rgb a{.0021, .0041, .0071}, s{2.19, 2.62, 3.00};
    const DiffuseProfile whole = make_diffuse_profile(medium_of(a, s, 1.5, kind));
    for (std::size_t empty = 0; empty < 3; ++empty) {
      Rgb a0 = a, s0 = s;
      a0[empty] = s0[empty] = 0;
      const DiffuseProfile part = make_diffuse_profile(medium_of(a0, s0, 1.5, kind));
      EXPECT_TRUE(part.translucent);
      EXPECT_TRUE(all_finite(part));
      for (std::size_t c = 0; c < 3; ++c) {
        if (c == empty) {
          EXPECT_EQ(part.total[c], 0);
          EXPECT_TRUE(std::holds_alternative<std::monostate>(part.channels[c]));
          continue;
        }
        EXPECT_EQ(bits(part.total[c]), bits(whole.total[c]));
        EXPECT_EQ(bits(part.mean_free_path[c]), bits(whole.mean_free_path[c]));
        for (const double r : {.01, .5, 5.}) {
          EXPECT_EQ(bits(diffuse_reflectance_profile(part.channels[c], r)),
                    bits(diffuse_reflectance_profile(whole.channels[c], r)));
          EXPECT_EQ(bits(near_field_reflectance(part.channels[c], r)),
                    bits(near_field_reflectance(whole.channels[c], r)));
        }
      }
    }
  }
}

// Claim: a mean free path of 0 is finite and Lambertian: all leaves within any radius, R_d is 0 beyond it,
// and the near field is the whole. Source: the limit. Tolerance: 1e-12. Fails if: 1/radius is taken.
TEST(MediumExtremes, ZeroMeanFreePath) {
  for (const ProfileKind kind : kAllProfiles) {
    const DiffuseProfile profile = make_diffuse_profile(medium_of(Rgb{.2, .8, 1}, Rgb(0), 0, 1.5, kind));
    EXPECT_TRUE(profile.translucent);
    EXPECT_TRUE(all_finite(profile));
    EXPECT_EQ(profile.mean_free_path, Rgb(0));
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(diffuse_reflectance_within(profile.channels[c], 1), profile.total[c], 1e-12);
      EXPECT_NEAR(near_field_reflectance(profile.channels[c], 1), profile.total[c], 1e-12);
      EXPECT_EQ(diffuse_reflectance_profile(profile.channels[c], 1), 0);
      EXPECT_FALSE(std::isnan(diffuse_reflectance_profile(profile.channels[c], 0)));
      EXPECT_EQ(diffuse_reflectance_within(profile.channels[c], 0), 0);
    }
  }
}

// Claim: huge, tiny and grazing values stay finite: coefficients 1e-12 and 1e12, g = +-.999, eta .3 to 8.
// Source: the contract. Tolerance: none. Fails if: a square of a coefficient leaves double's range or A turns
// negative.
TEST(MediumExtremes, WideRanges) {
  for (const ProfileKind kind : kAllProfiles)
    for (const double eta : {.3, .75, 1., 3.9, 8.}) {
      if (kind == ProfileKind::tabulated && eta != 1 && eta != 8) continue;  // walks take long
      for (const double a : {0., 1e-12, 1., 1e12})
        for (const double s : {1e-12, 1., 1e12}) {
          const DiffuseProfile profile = make_diffuse_profile(medium_of(Rgb(a), Rgb(s), eta, kind));
          EXPECT_TRUE(all_finite(profile)) << a << " " << s << " " << eta;
          EXPECT_TRUE(min_component(profile.total) >= 0 && max_component(profile.total) <= 1);
        }
      for (const double g : {-.999, .999})
        EXPECT_TRUE(
            all_finite(make_diffuse_profile(medium_of(Rgb{0, .5, 1}, Rgb{0, 1e-9, 1e9}, g, eta, kind))));
    }
}

// Claim: F_bar of the profile is the average from outside at the medium's eta. Source: section on energy of
// the conventions (radiance divides by 1 - F_bar). Tolerance: none. Fails if: the internal average is stored.
TEST(MediumExtremes, AverageReflectance) {
  const DiffuseProfile profile = make_diffuse_profile(medium_of(Rgb(.1), Rgb(1), 1.5));
  EXPECT_EQ(profile.average_reflectance, average_reflectance_outside(1.5));
  EXPECT_NEAR(profile.average_reflectance, .09177796, 5e-9);
  EXPECT_EQ(profile.eta, 1.5);
}

}  // namespace
}  // namespace opaline
