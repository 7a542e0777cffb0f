// SPDX-License-Identifier: GPL-3.0-or-later
// The dipole diffuse reflectance profile of one channel.
#pragma once

#include <type_traits>

#include "diffusion/reduced_medium.h"

namespace opaline {

/// Classical dipole (Jensen et al. 2001, sec. 2.2), with both sources at positive distances: every member is
/// finite for sigma_a = 0 and for a vanishing mean free path.
struct Dipole {
  double reduced_albedo = 0;  ///< alpha' = sigma_s' / sigma_t'
  double z_real = 0;          ///< depth of the real source, one mean free path 1/sigma_t', mm
  double z_virtual = 0;       ///< height of the virtual source, z_real (1 + 4A/3), mm
  double sigma_tr = 0;        ///< effective transport coefficient, 1/mm
  double s_real = 0;          ///< sigma_tr z_real = sqrt(3 (1 - alpha'))
  double s_virtual = 0;       ///< sigma_tr z_virtual
};

/// in    mean_free_path = 1/sigma_t' in mm, >= 0; absorbed = 1 - alpha' = sigma_a/sigma_t' in [0, 1]; A >= 1
Dipole make_dipole(double mean_free_path, double absorbed, double boundary_mismatch);

/// R_d(r) = alpha'/(4 pi) times the sum over both sources of z (1 + sigma_tr d) exp(-sigma_tr d) / d^3, d =
/// sqrt(r^2 + z^2); 1/mm^2, per transmitted flux, r >= 0 in mm.
double diffuse_reflectance_profile(const Dipole& dipole, double r);
/// Integral of 2 pi r' R_d(r') from 0 to r: the fraction of the transmitted flux leaving within r.
double diffuse_reflectance_within(const Dipole& dipole, double r);
/// The same to infinity: alpha'/2 (1 + exp(-4/3 A s)) exp(-s), s = sqrt(3 (1 - alpha')).
double total_diffuse_reflectance(const Dipole& dipole);
/// Profile for make_channel_profile (diffuse_profile.h).
Dipole make_profile(const ReducedMedium& medium, std::type_identity<Dipole>);
/// Samples as those of ChannelProfile: by Lambert's W, and by bisection.
double sample_diffusion_distance(const Dipole& profile, double beyond);
double sample_chord_sphere_radius(const Dipole& profile, double u, double v);
/// sigma_tr, 1/mm.
double slowest_decay(const Dipole& profile);

}  // namespace opaline
