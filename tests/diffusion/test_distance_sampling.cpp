// SPDX-License-Identifier: GPL-3.0-or-later
// Random distances of the profiles.
#include "core/random.h"
#include "diffusion/diffuse_profile.h"
#include "diffusion/diffusion_test.h"
#include "support/statistics.h"

namespace opaline {
namespace {

using namespace test;

struct NamedProfile {
  const char* name;
  ChannelProfile profile;
};

const std::vector<NamedProfile>& profiles() {
  static const std::vector<NamedProfile> table = {
      {"absorbing dipole", make_dipole(.38, .05, 2.6)},
      {"dipole without absorption", make_dipole(.38, 0, 2.6)},
      {"strongly absorbing dipole", make_dipole(.38, .95, 2.6)},
      {"dipole, eta 1", make_dipole(3, 1e-4, 1)},
      {"normalized diffusion", make_normalized_diffusion(.38, .8)},
      {"better dipole", make_channel_profile(ProfileKind::better_dipole, {.38, .05, 1.3})},
      {"better dipole without absorption", make_channel_profile(ProfileKind::better_dipole, {.38, 0, 1.5})},
      {"tabulated", make_channel_profile(ProfileKind::tabulated, {.38, .05, 1.3})},
      {"tabulated without absorption", make_channel_profile(ProfileKind::tabulated, {.38, 0, 1.5})},
  };
  return table;
}

constexpr std::size_t kSamples = 100000, kBins = 100;
const double kSignificance = sidak(.01, 2 * profiles().size());

double uniform(std::uint64_t stream, std::size_t i) {
  return unit_double(hash_bits(stream, i));
}

// Claim: distances have the density 2 pi r R_d / total. Source: their cumulative distribution is the closed
// form diffuse_reflectance_within, tested by quadrature elsewhere. Tolerance: chi-square over 100 bins of
// equal share, 100,000 samples, 1 % over this and the next test together (Sidak). Fails if: the choice of the
// source forgets exp(-sigma_tr z), or the logarithm of Golubev's inverse is over 3 instead of 4.
TEST(DistanceSampling, DistancesFollowTheProfile) {
  for (const auto& [name, profile] : profiles()) {
    std::vector<double> shares;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double r = sample_diffusion_distance(profile, 1 - uniform(1, i));
      shares.push_back(diffuse_reflectance_within(profile, r) / total_diffuse_reflectance(profile));
    }
    EXPECT_GT(uniformity(shares, kBins), kSignificance) << name;
  }
}

// Claim: radii of the chords' spheres have the density -pi R^2 R_d'(R) / total, whose integral by parts is
// (within(R) - pi R^2 R_d(R)) / total. Source: Crofton's formula; the header. Tolerance: as above. Fails if:
// the order-2 gamma of normalized diffusion takes one exponential, or a source's R^2 term has no half.
TEST(DistanceSampling, ChordRadiiFollowTheProfile) {
  for (const auto& [name, profile] : profiles()) {
    std::vector<double> shares;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double R = sample_chord_sphere_radius(profile, uniform(2, i), 1 - uniform(3, i));
      // A dipole without absorption has spheres so large that R^2 R_d is 0 x infinity to the last digits.
      const double outer = R < 1e30 ? pi * R * R * diffuse_reflectance_profile(profile, R) : 0;
      shares.push_back((diffuse_reflectance_within(profile, R) - outer) / total_diffuse_reflectance(profile));
    }
    EXPECT_GT(uniformity(shares, kBins), kSignificance) << name;
  }
}

/// The share that leaves beyond r, by which sample_diffusion_distance found it: of a dipole the virtual
/// source has the last part of all shares.
long double share_beyond(const ChannelProfile& profile, double beyond, double r) {
  if (const auto* burley = std::get_if<NormalizedDiffusion>(&profile)) {
    const Real x = Real(r) / Real(burley->d);
    return (std::exp(-x) + 3 * std::exp(-x / 3)) / 4;
  }
  if (const auto* better = std::get_if<BetterDipole>(&profile)) {
    const Real s = better->decay, h = better->height;
    const auto beyond_radius = [&](Real x) {
      const Real real = std::sqrt(x * x + 1), high = std::sqrt(x * x + h * h),
                 apart = (h * h - 1) / (real + high);
      return std::exp(-s * real) * (better->from_flux * (1 / real + h / high * std::exp(-s * apart)) +
                                    better->from_fluence * (s > 0 ? -std::expm1(-s * apart) / s : apart));
    };
    return beyond_radius(Real(r) / Real(better->mean_free_path)) / beyond_radius(0);
  }
  if (const auto* tabulated = std::get_if<TabulatedProfile>(&profile))
    return tabulated->shape->get().table.beyond(r / tabulated->mean_free_path);
  const Dipole& dipole = std::get<Dipole>(profile);
  const Real ratio = std::exp(Real(dipole.s_real) - Real(dipole.s_virtual));
  const Real of_virtual = ratio / (1 + ratio), of_real = 1 / (1 + ratio);
  const auto source = [&](Real z, Real s) {
    const Real y = std::sqrt(1 + Real(r) * Real(r) / (z * z));
    return std::exp(-s * (y - 1)) / y;
  };
  if (Real(beyond) <= of_virtual) return of_virtual * source(dipole.z_virtual, dipole.s_virtual);
  return of_virtual + of_real * source(dipole.z_real, dipole.s_real);
}

// Claim: the share beyond the distance is the one asked for, of the normalized diffusion profile as a whole,
// of a dipole within the source that the share chose. Source: the closed forms of the shares, in long double.
// Tolerance: 1e-12 relative from 1 to 1e-15, as the header states. Fails if: the dipole goes through
// 1 - beyond, which has lost all but one digit of 1e-15, or a source absorbs nothing below some sigma_tr z.
TEST(DistanceSampling, InvertsTheShareBeyond) {
  std::vector<NamedProfile> table = profiles();
  for (const double absorbed : {1e-9, 1e-15, 1e-17, 1e-20})
    table.push_back({"hardly absorbing dipole", make_dipole(.38, absorbed, 2.6)});
  table.push_back({"dipole, eta 3.9", make_dipole(.38, .5, boundary_mismatch(3.9))});
  for (const auto& [name, profile] : table)
    for (int i = 0; i <= 600; ++i) {
      const double beyond = std::pow(10, -i / 40.);
      const double r = sample_diffusion_distance(profile, beyond);
      EXPECT_LT(std::abs(share_beyond(profile, beyond, r) / beyond - 1), 1e-12) << name << " " << beyond;
    }
}

// Claim: the share beyond the distance of normalized diffusion and the share within it are the total. Source:
// diffuse_reflectance_within. Tolerance: 1e-9 of the total. Fails if: as above.
TEST(DistanceSampling, WithinAndBeyondAreTheTotal) {
  const ChannelProfile profile = make_normalized_diffusion(.38, .8);
  for (int i = 0; i <= 600; ++i) {
    const double beyond = std::pow(10, -i / 40.), r = sample_diffusion_distance(profile, beyond);
    EXPECT_NEAR(diffuse_reflectance_within(profile, r) + .8 * beyond, .8, .8e-9) << beyond;
  }
}

// Claim: distances and radii are finite and not negative at the ends of what may be asked, 0 for a mean free
// path of 0 and, within 1e-7 mean free paths (the root of what rounds d / z off 1), for the whole share.
// Source: the header. Fails if: (y - 1)(y + 1) may be rounded below 0, or its root is taken of a square that
// overflows.
TEST(DistanceSampling, ExtremesAreFinite) {
  std::vector<NamedProfile> table = profiles();
  for (const double absorbed : {1e-300, 1e-18, .5, 1 - 1e-9, 1 - 0x1p-53})
    for (const double A : {1., 2.6, 1e3, 1e6}) table.push_back({"dipole", make_dipole(.38, absorbed, A)});
  for (const double l : {0., 1e-300, 1e-12, 1e12}) {
    table.push_back({"dipole of another size", make_dipole(l, 1e-3, 2.6)});
    table.push_back({"dipole of another size, no absorption", make_dipole(l, 0, 2.6)});
    table.push_back({"normalized diffusion of another size", make_normalized_diffusion(l, .8)});
  }
  const double largest = 1 - 0x1p-53;
  for (const auto& [name, profile] : table) {
    for (const double beyond : {1., largest, .5, 1e-8, 1e-15, 0x1p-53, 1e-200}) {
      const double r = sample_diffusion_distance(profile, beyond);
      EXPECT_TRUE(std::isfinite(r) && r >= 0) << name << " " << beyond << " " << r;
    }
    const auto* dipole = std::get_if<Dipole>(&profile);
    EXPECT_LE(sample_diffusion_distance(profile, 1), dipole ? 1e-7 * dipole->z_real : 0) << name;
    for (const double u : {0x1p-53, 1e-8, .25, .5, 1 - 1e-8, largest})
      for (const double v : {0x1p-53, .5, largest}) {
        const double R = sample_chord_sphere_radius(profile, u, v);
        EXPECT_TRUE(std::isfinite(R) && R >= 0) << name << " " << u << " " << v << " " << R;
      }
  }
  for (const ChannelProfile& empty :
       {ChannelProfile(make_dipole(0, .1, 2.6)), ChannelProfile(make_normalized_diffusion(0, .8))})
    for (const double u : {1e-15, .3, .9}) {
      EXPECT_EQ(sample_diffusion_distance(empty, u), 0);
      EXPECT_EQ(sample_chord_sphere_radius(empty, u, .5), 0);
    }
}

}  // namespace
}  // namespace opaline
