// SPDX-License-Identifier: GPL-3.0-or-later
// The directional dipole of one channel: depends on the direction of incidence.
#pragma once

#include <type_traits>

#include "diffusion/reduced_medium.h"
#include "diffusion/table_profile.h"
#include "opaline/vec3.h"

namespace opaline {

/// Source along the refracted ray, and its image in a plane through entry and exit (Frisvad, Hachisuka &
/// Kjeldsen 2014, Directional Dipole Model for Subsurface Scattering), in mean free paths. As published:
/// negative values are clamped to 0; not reciprocal, and not energy conserving (published_total).
struct DirectionalKernel {
  double eta = 1;
  double decay = 0;          ///< sigma_tr
  double extrapolation = 0;  ///< d_e = 2.131 D / sqrt(alpha')
  double image = 0;          ///< 2 A d_e, height of the virtual source
  double from_fluence = 0;   ///< C_phi
  double from_flux = 0;      ///< C_E
};

/// The kernel scaled to the exact albedo for diffuse light. Functions without a direction are means over
/// diffuse light, from a table of some 3 ms of quadrature.
struct DirectionalDipole : TableProfile {
  DirectionalKernel kernel;
};

/// Total for diffuse light as published: 1.19 at eta 1.5 and 1.31 at eta 1 without absorption, and 0.12 and
/// 0.33 without scattering.
double published_total(const DirectionalDipole& profile);

/// A point of entry or exit.
struct DirectedPlace {
  Vec3d position, normal;  ///< mm; unit, outward
};

/// Radiant exitance at `exit`, 1/mm^2, per unit of flux transmitted at `entry` from the direction
/// `towards_light` (unit, outside). As for all profiles, the transmitted flux includes the boundary at the
/// entry, and the exitance the boundary at the exit.
/// in    dot(towards_light, entry.normal) > 0
/// out   >= 0; where the modified normal is undefined, it is the entry's own (coincident entry and exit), or
///       any perpendicular one (exit straight below the entry)
double directional_reflectance(const DirectionalDipole& profile, const DirectedPlace& entry,
                               const Vec3d& towards_light, const DirectedPlace& exit);
/// Total reflectance for incidence at this cosine outside; by quadrature.
double total_directional_reflectance(const DirectionalDipole& profile, double cosine);

/// Profile for make_channel_profile (diffuse_profile.h).
DirectionalDipole make_profile(const ReducedMedium& medium, std::type_identity<DirectionalDipole>);

}  // namespace opaline
