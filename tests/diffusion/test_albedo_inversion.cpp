// SPDX-License-Identifier: GPL-3.0-or-later
// From an artist's colour to a medium and back.
#include "diffusion/diffusion_test.h"

namespace opaline {
namespace {

using namespace test;

constexpr double kColours[] = {0, .001, .5, .8, .999, 1};

// Claim: the medium made from a colour has that colour as its total diffuse reflectance, for all profiles,
// every anisotropy and boundary. Source: definition of subsurface_color. Tolerance: 1e-10 (bisection to
// 1e-12). Fails if: the colour is taken for the single-scattering albedo.
TEST(AlbedoInversion, RoundTrip) {
  for (const ProfileKind kind : kAllProfiles)
    for (const double eta : {1.0, 1.5, .75})
      for (const double g : {-.999, 0., .9, .999})
        for (const double colour : kColours) {
          const DiffuseProfile profile = make_diffuse_profile(medium_of(Rgb(colour), Rgb(.5), g, eta, kind));
          for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(profile.total[c], colour, 1e-10) << eta << " " << g;
            EXPECT_NEAR(total_diffuse_reflectance(profile.channels[c]), colour, 1e-10) << eta << " " << g;
          }
        }
}

// Claim: the ends are exact: colour 1 absorbs nothing, colour 0 gives exactly 0. Source: definition.
// Tolerance: none. Fails if: bisection stops short of its ends.
TEST(AlbedoInversion, EndsAreExact) {
  for (const double eta : {1.0, 1.3, 2.0}) {
    EXPECT_EQ(invert_albedo(ProfileKind::dipole, 1, eta), 0);
    EXPECT_EQ(invert_albedo(ProfileKind::dipole, 0, eta), 1);
  }
  EXPECT_EQ(make_diffuse_profile(medium_of(Rgb(0), Rgb(.5), 0, 1.3)).total, Rgb(0));
  EXPECT_EQ(make_diffuse_profile(medium_of(Rgb(1), Rgb(.5), 0, 1.3)).total, Rgb(1));
}

// Claim: 1 - alpha' comes back from its total with its digits. Source: closed form in long double. Tolerance:
// 1e-12 relative, or what one rounding of the total is worth in it (near total 1: a few 1e-16 / (1 - total)),
// whichever is more. Fails if: bisection runs over alpha'.
TEST(AlbedoInversion, KeepsDigitsOfAbsorption) {
  for (const double eta : {1.0, 1.3, 2.0})
    for (const double absorbed : {1e-8, 1e-4, .01, .1, .5, .9, .999}) {
      const double total = double(reference_dipole_total(absorbed, boundary_mismatch(eta)));
      const double bar = std::max(1e-12, 5e-16 / (1 - total) + 5e-16 / (1 - absorbed));
      EXPECT_NEAR(invert_albedo(ProfileKind::dipole, total, eta) / absorbed, 1, bar)
          << eta << " " << absorbed;
    }
}

// Claim: subsurface_radius is 1/sigma_t, so the mean free path is 1/sigma_t' = radius (1 - g + g alpha')/(1 -
// g) with alpha' = (1 - g) alpha / (1 - g alpha). Source: definitions of the reduced coefficients. Tolerance:
// 1e-9. Fails if: the radius is taken for the reduced mean free path (same only at g = 0).
TEST(AlbedoInversion, RadiusIsTheUnreducedMeanFreePath) {
  for (const double g : {-.999, 0., .9, .999})
    for (const double colour : {.001, .5, .8, .999, 1.}) {
      const DiffuseProfile profile = make_diffuse_profile(medium_of(Rgb(colour), Rgb{.5, 1, 2}, g, 1.5));
      const double reduced = 1 - invert_albedo(ProfileKind::dipole, colour, 1.5);
      const double expected = (1 - g + g * reduced) / (1 - g);
      EXPECT_NEAR(profile.mean_free_path.x / (.5 * expected), 1, 1e-9) << g << " " << colour;
      EXPECT_NEAR(profile.mean_free_path.y / expected, 1, 1e-9) << g << " " << colour;
      EXPECT_NEAR(profile.mean_free_path.z / (2 * expected), 1, 1e-9) << g << " " << colour;
    }
}

}  // namespace
}  // namespace opaline
