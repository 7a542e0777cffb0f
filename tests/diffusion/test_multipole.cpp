// SPDX-License-Identifier: GPL-3.0-or-later
// The multipole profile.
#include "diffusion/diffusion_test.h"
#include "transport/laboratory.h"

namespace opaline {
namespace {

using namespace test;

Multipole plate(double thickness, double absorbed, double eta, double mean_free_path = 1) {
  return make_profile({mean_free_path, absorbed, eta, thickness}, std::type_identity<Multipole>());
}

// Claim: an endless thickness is the dipole that it is built on, and a thick plate comes near it, for any absorption.
// Source: Donner & Jensen 2005; test_dipole_profile. Tolerance: 1e-12; 1 % at 200 mean free paths within 5 of them.
// Fails if: the boundary's A is another's, or the source lies deeper.
TEST(MultipoleProfile, ThickIsTheDipole) {
  for (const double absorbed : {0., .001, .3})
    for (const double eta : {1., 1.5}) {
      const Multipole endless = plate(INFINITY, absorbed, eta, .4), thick = plate(80, absorbed, eta, .4);
      const Dipole dipole = make_dipole(.4, absorbed, boundary_mismatch(eta));
      EXPECT_NEAR(total_diffuse_reflectance(endless), total_diffuse_reflectance(dipole), 1e-12);
      EXPECT_EQ(total_diffuse_transmittance(endless), 0);
      for (const double r : {0., .01, .4, 2., 20.}) {
        const double expected = diffuse_reflectance_profile(dipole, r);
        EXPECT_NEAR(diffuse_reflectance_profile(endless, r) / expected, 1, 1e-12) << r;
        EXPECT_EQ(diffuse_transmittance_profile(endless, r), 0);
        EXPECT_NEAR(diffuse_reflectance_within(endless, r), diffuse_reflectance_within(dipole, r), 1e-12)
            << r;
        if (r <= 2) {
          EXPECT_NEAR(diffuse_reflectance_profile(thick, r) / expected, 1, .01) << r;
        }
      }
    }
}

/// Sum over 2 x 20,000 images in long double, at the face (0 or the thickness), per source strength.
long double images(const Multipole& p, double face, long double r) {
  const long double d = p.thickness, b = p.extrapolation, period = 2 * (d + 2 * b), s = p.decay;
  const auto flux = [&](long double z) {
    const long double apart = face > 0 ? d - z : z, length = std::sqrt(r * r + apart * apart);
    return apart * (1 + s * length) * std::exp(-s * length) / (length * length * length);
  };
  long double sum = 0;
  for (int i = 20000; i >= 0; --i)
    for (const int side : {-1, 1}) {
      if (i == 0 && side > 0) continue;
      const long double z = side * i * period;
      sum += flux(z + p.depth) - flux(z - p.depth - 2 * b);
    }
  return sum / (4 * kPiLong);
}

// Claim: both faces are the sum over all images, near and far, in plates a tenth to a hundred mean free paths thick.
// Source: the sum, without an end in sight. Tolerance: 1e-5 of the larger side. Fails if: the integral in place of the
// far images has the wrong sign, or the modes another height.
TEST(MultipoleProfile, IsTheSumOverImages) {
  for (const double absorbed : {0., .01})
    for (const double eta : {1., 1.5})
      for (const double thickness : {.1, 1., 7., 100.}) {
        const Multipole p = plate(thickness, absorbed, eta);
        const double height = thickness + 2 * p.extrapolation;
        for (const double r : {.01, .3, .2 * height, .49 * height, .51 * height, 1.5 * height}) {
          const double back = p.strength * double(images(p, 0, r)),
                       through = p.strength * double(images(p, thickness, r));
          const double bar = 1e-5 * std::max(back, through);
          EXPECT_NEAR(diffuse_reflectance_profile(p, r), back, bar)
              << absorbed << " " << thickness << " " << r;
          EXPECT_NEAR(diffuse_transmittance_profile(p, r), through, bar)
              << absorbed << " " << thickness << " " << r;
        }
      }
}

// Claim: both faces integrate to their closed totals, within(r) is the running integral, and without absorption all
// that collides leaves: alpha' (1 - e^-tau). Source: quadrature; energy. Tolerance: 1e-6; 1e-12 for energy. Fails if:
// cosh(s b) is left out, or the images' shares are summed without their signs.
TEST(MultipoleProfile, Integrals) {
  for (const double eta : {.75, 1., 1.5, 3.})
    for (const double thickness : {.05, .5, 3., 40.}) {
      const Multipole clear = plate(thickness, 0, eta);
      EXPECT_NEAR(total_diffuse_reflectance(clear) + total_diffuse_transmittance(clear),
                  -std::expm1(-thickness), 1e-12);
      const Multipole p = plate(thickness, .02, eta);
      const auto back = [&](double r) { return diffuse_reflectance_profile(p, r); };
      const auto through = [&](double r) { return diffuse_transmittance_profile(p, r); };
      const double scale = std::min(p.depth, 1.), end = 60 / slowest_decay(p);
      EXPECT_NEAR(plane_integral(back, scale, end) / total_diffuse_reflectance(p), 1, 1e-6) << thickness;
      EXPECT_NEAR(plane_integral(through, scale, end) / total_diffuse_transmittance(p), 1, 1e-6) << thickness;
      for (const double r : {.1, 1., 10.}) {
        EXPECT_NEAR(diffuse_reflectance_within(p, r) / plane_integral(back, std::min(scale, r), r), 1, 1e-6);
        EXPECT_NEAR(diffuse_transmittance_within(p, r) / plane_integral(through, std::min(scale, r), r), 1,
                    1e-6);
      }
    }
}

// Claim: of plates it says what walks do, far better than a dipole: the reflected total within .06, the transmitted
// one, uncollided light apart, within .06, where a dipole sends back and through up to .2 too much and too little.
// Source: the laboratory. Tolerance: that, the model's own error at eta 1.5 and absorbed .001 to .01. Fails if: the
// source of a thin plate lies outside of it.
TEST(MultipoleProfile, NearTheWalksInPlates) {
  for (const double absorbed : {.001, .01})
    for (const double thickness : {.5, 1., 2., 5., 10.}) {
      LaboratorySettings settings;
      settings.walks = 20000;
      const SlabWalks walked =
          walk_slab({absorbed, 1 - absorbed, 0, 1.5}, {thickness}, kDiffuseEntry, settings);
      const Multipole p = plate(thickness, absorbed, 1.5);
      const double through = walked.through.total.value - walked.through.uncollided.value;
      EXPECT_NEAR(total_diffuse_reflectance(p), walked.back.total.value, .06) << absorbed << " " << thickness;
      EXPECT_NEAR(total_diffuse_transmittance(p), through, .06) << absorbed << " " << thickness;
    }
}

// Claim: from plates of a billionth of a mean free path to a billion, with and without absorption, all is finite, not
// negative, and no light is made; what crosses tends to 0 at either end. Source: the contract. Fails if: sinh overflows,
// or 1 - tau / (e^tau - 1) cancels.
TEST(MultipoleProfile, Extremes) {
  for (const double eta : {.75, 1., 3.})
    for (const double absorbed : {0., 1e-12, .5, 1 - 1e-12})
      for (const double thickness : {1e-9, 1e-3, 1., 1e3, 1e9}) {
        const Multipole p = plate(thickness, absorbed, eta);
        const double back = total_diffuse_reflectance(p), through = total_diffuse_transmittance(p);
        EXPECT_TRUE(back >= 0 && through >= 0 && back + through <= 1 + 1e-12) << eta << absorbed << thickness;
        for (const double r : {0., 1e-12, 1e-3, 1., 1e3, 1e9, 1e30}) {
          const double values[] = {diffuse_reflectance_profile(p, r), diffuse_transmittance_profile(p, r),
                                   diffuse_reflectance_within(p, r), diffuse_transmittance_within(p, r)};
          for (const double v : values)
            EXPECT_TRUE(std::isfinite(v) && v >= -1e-15)
                << eta << " " << absorbed << " " << thickness << " " << r;
        }
        for (const double u : {1., .7, .3, 1e-6, 1e-15}) {
          const double r = sample_diffusion_distance(p, u), chord = sample_chord_sphere_radius(p, 1 - u, .5);
          EXPECT_TRUE(std::isfinite(r) && r >= 0 && std::isfinite(chord) && chord >= 0)
              << thickness << " " << u;
        }
        EXPECT_TRUE(std::isfinite(slowest_decay(p)));
      }
  EXPECT_LT(total_diffuse_reflectance(plate(1e-9, 0, 1.5)), 1e-9);
}

// Claim: distances are drawn from the reflected side. Source: within. Tolerance: 2e-6 of the share. Fails if: the
// table's slope is that of r, not of ln r.
TEST(MultipoleProfile, Distances) {
  for (const double thickness : {.1, 2., 30.})
    for (const double absorbed : {0., .02}) {
      const Multipole p = plate(thickness, absorbed, 1.4, .38);
      const double total = total_diffuse_reflectance(p);
      for (double beyond = .9999; beyond > 1e-4; beyond *= .83) {
        const double r = sample_diffusion_distance(p, beyond);
        EXPECT_NEAR(diffuse_reflectance_within(p, r) / total, 1 - beyond, 2e-6) << thickness << " " << beyond;
      }
    }
}

// Claim: a medium's thickness is in its own unit, whole bodies have no far side, and a colour is that of a thick piece.
// Source: the contract. Fails if: the thickness is not divided by the world's unit, or the colour is inverted by the
// plate's total.
TEST(MultipoleProfile, OfAMedium) {
  Medium medium = medium_of(Rgb(.01), Rgb(1), 1.5, ProfileKind::multipole);
  EXPECT_FALSE(make_diffuse_profile(medium).has_far_side);
  medium.thickness = 4;
  const DiffuseProfile in_mm = make_diffuse_profile(medium), in_cm = make_diffuse_profile(medium, 10);
  EXPECT_TRUE(in_mm.has_far_side);
  EXPECT_NEAR(in_cm.total.x, in_mm.total.x, 1e-12);
  EXPECT_NEAR(far_side_profile(in_cm.channels[0], .5), 100 * far_side_profile(in_mm.channels[0], 5), 1e-10);
  EXPECT_EQ(far_side_profile(in_mm.channels[0], 3), far_side_profile(in_mm.channels[0], 4));
  Medium coloured = medium_of(Rgb(.7), Rgb(1), 0, 1.5, ProfileKind::multipole);
  const double absorbed = invert_albedo(ProfileKind::dipole, .7, 1.5);
  coloured.thickness = 2;
  const Multipole p = std::get<Multipole>(make_diffuse_profile(coloured).channels[0]);
  EXPECT_NEAR(p.decay, std::sqrt(3 * absorbed), 1e-9);
  EXPECT_LT(make_diffuse_profile(coloured).total.x, .7);
}

}  // namespace
}  // namespace opaline
