// SPDX-License-Identifier: GPL-3.0-or-later
// The better dipole's diffuse reflectance profile of one channel.
#pragma once

#include <type_traits>

#include "opaline/diffusion/reduced_medium.h"

namespace opaline {

/// Grosjean's diffusion coefficient, and what leaves taken from fluence and flux (d'Eon 2012, A Better Dipole;
/// d'Eon & Irving 2011). Multiple scattering alone: light that leaves after one collision is not in it, but at
/// alpha' = 1 its total is 1 nonetheless, so that adding single scattering would make energy. Lengths and
/// rates in mean free paths, so that every member is finite for sigma_a = 0 and a vanishing mean free path.
struct BetterDipole {
  double mean_free_path = 0;  ///< 1/sigma_t', mm: depth of the real source
  double strength = 0;        ///< alpha'^2
  double height = 1;          ///< of the virtual source, 1 + 4AD
  double decay = 0;           ///< sigma_tr = sqrt(3 (1 - alpha') / (2 - alpha'))
  double from_fluence = 0;    ///< C_phi / D
  double from_flux = 0;       ///< C_E
};

/// As those of ChannelProfile (diffuse_profile.h). The total has the closed form alpha'^2/2 e^-s (C_E (1 +
/// e^-4A mu) + C_phi/mu (1 - e^-4A mu)), s = sigma_tr, mu = s D.
BetterDipole make_profile(const ReducedMedium& medium, std::type_identity<BetterDipole>);
double diffuse_reflectance_profile(const BetterDipole& profile, double r);
double diffuse_reflectance_within(const BetterDipole& profile, double r);
double total_diffuse_reflectance(const BetterDipole& profile);
double sample_diffusion_distance(const BetterDipole& profile, double beyond);
double sample_chord_sphere_radius(const BetterDipole& profile, double u, double v);
double slowest_decay(const BetterDipole& profile);

}  // namespace opaline
