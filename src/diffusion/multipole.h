// SPDX-License-Identifier: GPL-3.0-or-later
// The multipole: a dipole between two faces (Donner & Jensen 2005), one channel.
#pragma once

#include <memory>
#include <type_traits>
#include <vector>

#include "diffusion/reduced_medium.h"

namespace opaline {

/// Distances by the fraction of light beyond them.
struct ShareTable {
  /// Ascending ln r, ln of the shares within and beyond, and the derivatives of ln r by those.
  std::vector<double> distance, within, beyond, slope_within, slope_beyond;
  double decay = 0;  ///< decay of the lowest mode: after the last row
};

/// A plate of a given thickness. The source is one point at the mean depth of first collisions within the
/// plate, with the fraction of light colliding there: in a thick plate one mean free path deep, as in the
/// dipole. Repeatedly mirrored at both extrapolated faces. Excludes light crossing the plate without a
/// collision. Lengths in mean free paths, so every member but the thickness is finite for any mean free path.
struct Multipole {
  double mean_free_path = 0;                 ///< 1/sigma_t', mm
  double thickness = 0;                      ///< may be infinite: then equal to the dipole
  double strength = 0;                       ///< alpha' (1 - e^-thickness)
  double depth = 1;                          ///< depth of the source
  double extrapolation = 0;                  ///< 2 A D, beyond either face
  double decay = 0;                          ///< sigma_tr
  std::shared_ptr<const ShareTable> shares;  ///< table of the reflected side; none for the dipole
};

/// Profile for make_channel_profile (diffuse_profile.h).
Multipole make_profile(const ReducedMedium& medium, std::type_identity<Multipole>);
/// R_d(r), 1/mm^2, per transmitted flux, r >= 0 in mm.
double diffuse_reflectance_profile(const Multipole& profile, double r);
/// Fraction of the transmitted flux leaving through the same face within r, mm.
double diffuse_reflectance_within(const Multipole& profile, double r);
/// strength sinh(s (d + b - z)) cosh(s b) / sinh(s (d + 2 b)), b the extrapolation, z the source's depth.
double total_diffuse_reflectance(const Multipole& profile);
/// Samples as those of ChannelProfile: by cubics through a table, relative error of the share below 1e-6, and
/// by bisection.
double sample_diffusion_distance(const Multipole& profile, double beyond);
double sample_chord_sphere_radius(const Multipole& profile, double u, double v);
/// Slowest decay of the lowest mode across the plate, sqrt(sigma_tr^2 + (pi / (d + 2 b))^2), 1/mm.
double slowest_decay(const Multipole& profile);

/// T(r): exitance of the other face, 1/mm^2; r, along the plate, >= 0 in mm.
double diffuse_transmittance_profile(const Multipole& profile, double r);
/// Fraction of the transmitted flux leaving through the other face within r, mm.
double diffuse_transmittance_within(const Multipole& profile, double r);
/// strength sinh(s (z + b)) cosh(s b) / sinh(s (d + 2 b)).
double total_diffuse_transmittance(const Multipole& profile);

}  // namespace opaline
