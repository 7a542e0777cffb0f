// SPDX-License-Identifier: GPL-3.0-or-later
// The better dipole's diffuse reflectance profile of one channel.
#pragma once

#include <type_traits>

#include "diffusion/reduced_medium.h"

namespace opaline {

/// Grosjean's diffusion coefficient, with exitance from fluence and flux (d'Eon 2012, A Better Dipole; d'Eon
/// & Irving 2011). Multiple scattering only; adding single scattering would violate energy conservation, as
/// the total is already 1 at alpha' = 1. Lengths and rates are in mean free paths, so every member is finite
/// for sigma_a = 0 and a vanishing mean free path.
struct BetterDipole {
  double mean_free_path = 0;  ///< 1/sigma_t', mm: depth of the real source
  double strength = 0;        ///< alpha'^2
  double height = 1;          ///< height of the virtual source, 1 + 4AD
  double decay = 0;           ///< sigma_tr = sqrt(3 (1 - alpha') / (2 - alpha'))
  double from_fluence = 0;    ///< C_phi / D
  double from_flux = 0;       ///< C_E
};

/// Profile for make_channel_profile (diffuse_profile.h).
BetterDipole make_profile(const ReducedMedium& medium, std::type_identity<BetterDipole>);
/// R_d(r), 1/mm^2, per transmitted flux, r >= 0 in mm.
double diffuse_reflectance_profile(const BetterDipole& profile, double r);
/// Fraction of the transmitted flux leaving within r, mm.
double diffuse_reflectance_within(const BetterDipole& profile, double r);
/// alpha'^2/2 e^-s (C_E (1 + e^-4A mu) + C_phi/mu (1 - e^-4A mu)), s = sigma_tr, mu = s D.
double total_diffuse_reflectance(const BetterDipole& profile);
/// Samples as those of ChannelProfile, by bisection.
double sample_diffusion_distance(const BetterDipole& profile, double beyond);
double sample_chord_sphere_radius(const BetterDipole& profile, double u, double v);
/// sigma_tr, 1/mm.
double slowest_decay(const BetterDipole& profile);

}  // namespace opaline
