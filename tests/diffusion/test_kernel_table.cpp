// SPDX-License-Identifier: GPL-3.0-or-later
// The tabulated kernel.
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "diffusion/diffusion_test.h"
#include "diffusion/kernel_table.h"

namespace opaline {
namespace {

using namespace test;

struct NamedMedium {
  std::string name;
  DiffuseProfile profile;
};

std::vector<NamedMedium> table_of_media() {
  const Rgb a{.0021, .0041, .0071}, s{2.19, 2.62, 3.00};
  std::vector<NamedMedium> all;
  for (const ProfileKind kind : kAllProfiles) {
    const std::string name(kProfileNames[std::size_t(kind)]);
    all.push_back({"marble, " + name, make_diffuse_profile(medium_of(a, s, 1.5, kind))});
    all.push_back(
        {"unabsorbing, " + name, make_diffuse_profile(medium_of(Rgb(0), Rgb{.5, 2, 40}, 1.3, kind))});
    all.push_back({"dark, " + name, make_diffuse_profile(medium_of(Rgb{1, .1, 5}, Rgb{1, 5, .5}, 1, kind))});
  }
  return all;
}

std::array<float, 4> lanes(__m128 v) {
  std::array<float, 4> out;
  _mm_storeu_ps(out.data(), v);
  return out;
}

/// The table's error in a channel relative to R_d where R_d exceeds 1e-9 of its largest, R_d(r_min).
double largest_error(const KernelTable& table, const ChannelProfile& channel, std::size_t c, double r_min,
                     double r_max) {
  const double floor = 1e-9 * diffuse_reflectance_profile(channel, r_min);
  double largest = 0;
  const auto check = [&](float r2) {
    const double expected = diffuse_reflectance_profile(channel, std::sqrt(double(r2)));
    if (expected > floor) largest = std::max(largest, std::abs(double(lanes(table(r2))[c]) / expected - 1));
  };
  const double octaves = 2 * std::log2(r_max / r_min);
  const int n = 100000;
  for (int i = 1; i < n; ++i) check(float(r_min * r_min * std::exp2(octaves * i / n)));
  return largest;
}

// Claim: between r_min and r_max the table is R_d within 4e-6 wherever R_d is above 1e-9 of its largest.
// Source: the header's promise. Tolerance: that. Fails if: 16 segments an octave stand for 32 (4.3e-5), or a
// cubic's coefficient is off.
TEST(KernelTable, IsTheProfile) {
  double largest = 0;
  for (const auto& [name, profile] : table_of_media())
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = largest_error(KernelTable(profile, 2e-3, 400), profile.channels[c], c, 2e-3, 400);
      largest = std::max(largest, error);
      EXPECT_LT(error, 4e-6) << name << " " << c;
    }
  std::printf("             largest relative error %.3g\n", largest);
}

// Claim: the whole way, down to float's smallest normal number, the table is finite, not negative, and close
// to R_d. Source: the contract of evaluate, exitance >= 0. Tolerance: 1e-4 of R_d plus 1e-13 of its largest:
// what is lost below adds nothing to a sum; denormals, which evaluation flushes, may have either sign. Fails
// if: a cubic overshoots below zero in the tail.
TEST(KernelTable, TailIsSmallAndNotNegative) {
  for (const auto& [name, profile] : table_of_media()) {
    const KernelTable table(profile, 2e-3, 400);
    for (double r = 2e-3; r < 400; r *= 1.0007) {
      const float r2 = float(r * r);
      for (std::size_t c = 0; c < 3; ++c) {
        const float got = lanes(table(r2))[c];
        const double largest = diffuse_reflectance_profile(profile.channels[c], 2e-3);
        const double expected = diffuse_reflectance_profile(profile.channels[c], std::sqrt(double(r2)));
        ASSERT_TRUE(std::isfinite(got) && got > -std::numeric_limits<float>::min())
            << name << " " << c << " r " << r << ": " << got;
        ASSERT_NEAR(got, expected, 1e-4 * expected + 1e-13 * largest) << name << " " << c << " r " << r;
      }
    }
  }
}

// Claim: below its range, which begins at r_min or up to an octave of r^2 before, the table is constant, r =
// 0 included; beyond it, at latest an octave of r^2 after r_max, it is exactly 0; the fourth lane is always
// 0. Source: the header. Tolerance: 1e-5 of R_d at either end of that octave; none beyond. Fails if: the last
// segment is not zero, or the bits of r2 = 0 index before the table.
TEST(KernelTable, BeyondItsRange) {
  for (const auto& [name, profile] : table_of_media()) {
    const double r_min = .01, r_max = 30;
    const KernelTable table(profile, r_min, r_max);
    for (std::size_t c = 0; c < 3; ++c) {
      const double low = diffuse_reflectance_profile(profile.channels[c], r_min) * (1 - 1e-5);
      const double high =
          diffuse_reflectance_profile(profile.channels[c], r_min / std::sqrt(2.)) * (1 + 1e-5);
      for (const float r2 : {0.f, 1e-40f, 1e-12f, float(r_min * r_min * .49)}) {
        EXPECT_GE(double(lanes(table(r2))[c]), low) << name << " " << c << " r2 " << r2;
        EXPECT_LE(double(lanes(table(r2))[c]), high) << name << " " << c << " r2 " << r2;
        EXPECT_EQ(lanes(table(r2))[c], lanes(table(0.f))[c]);
      }
      for (const float r2 : {float(r_max * r_max * 2.0001), 1e4f, 1e30f, 3e38f, INFINITY})
        EXPECT_EQ(lanes(table(r2))[c], 0) << name << " " << c << " r2 " << r2;
      EXPECT_EQ(lanes(table(1.f))[3], 0);
    }
  }
}

// Claim: with r and mean free paths times 8 all values are 1/64, bit for bit. Source: the header; pictures at
// another scale must be the same bytes. Tolerance: none; below 1e-30, where a cubic's coefficients near
// float's smallest number lose bits (1e-38), that. Fails if: the table's knots are at powers of two of mm, or
// r_min has a floor in mm.
TEST(KernelTable, PowersOfTwoScale) {
  for (const ProfileKind kind : kAllProfiles)
    for (const double k : {8., 1 / 1024.}) {
      const Rgb a{.0021, .0041, .0071}, s{2.19, 2.62, 3.00};
      const KernelTable small(make_diffuse_profile(medium_of(a, s, 1.5, kind)), 1e-3, 100);
      const KernelTable large(make_diffuse_profile(medium_of(a / k, s / k, 1.5, kind)), 1e-3 * k, 100 * k);
      const float k2 = float(k * k);
      for (double r = 1e-4; r < 200; r *= 1.003) {
        const float r2 = float(r * r);
        const auto near = lanes(small(r2)), far = lanes(large(r2 * k2));
        for (std::size_t c = 0; c < 4; ++c) {
          if (near[c] > 1e-30f && far[c] > 1e-30f) {
            ASSERT_EQ(far[c] * k2, near[c]) << r << " " << c << " " << k;
          } else {
            ASSERT_NEAR(far[c] * k2, near[c], 1e-30 * (1 + double(k2))) << r << " " << c << " " << k;
          }
        }
      }
    }
}

// Claim: three distances at once are the three lookups, to the bit. Source: the header. Tolerance: none.
// Fails if: a channel's offset is taken from another's distance.
TEST(KernelTable, ThreeDistances) {
  const KernelTable table(table_of_media()[0].profile, 1e-3, 100);
  const std::array<float, 7> distances = {0, 1e-7f, .013f, .5f, 7, 900, 1e5f};
  for (const float r : distances)
    for (const float g : distances)
      for (const float b : distances) {
        const std::array<float, 4> together = lanes(table(r, g, b));
        const std::array<float, 4> alone = {lanes(table(r))[0], lanes(table(g))[1], lanes(table(b))[2], 0};
        EXPECT_EQ(std::memcmp(&together, &alone, sizeof together), 0) << r << " " << g << " " << b;
      }
}

// Claim: an empty channel is 0 everywhere and moves no bit of the others; a mean free path of 0 is finite.
// Source: defect of a peer. Tolerance: none. Fails if: the table's range comes from the smallest mean free
// path.
TEST(KernelTable, EmptyChannel) {
  const Rgb a{.0021, .0041, .0071}, s{2.19, 2.62, 3.00};
  const KernelTable whole(make_diffuse_profile(medium_of(a, s, 1.5)), 1e-3, 100);
  const KernelTable part(make_diffuse_profile(medium_of(Rgb{a.x, 0, a.z}, Rgb{s.x, 0, s.z}, 1.5)), 1e-3, 100);
  const KernelTable flat(make_diffuse_profile(medium_of(Rgb(.8), Rgb(0), 0, 1.5)), 1e-3, 100);
  for (double r = 1e-4; r < 200; r *= 1.01) {
    const auto expected = lanes(whole(float(r * r))), got = lanes(part(float(r * r)));
    ASSERT_EQ(got[0], expected[0]) << r;
    ASSERT_EQ(got[1], 0) << r;
    ASSERT_EQ(got[2], expected[2]) << r;
    for (const float v : lanes(flat(float(r * r)))) ASSERT_EQ(v, 0) << r;
  }
}

}  // namespace
}  // namespace opaline
