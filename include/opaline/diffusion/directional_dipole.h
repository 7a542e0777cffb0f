// SPDX-License-Identifier: GPL-3.0-or-later
// The directional dipole of one channel: it knows from where the light came.
#pragma once

#include <memory>
#include <type_traits>

#include "opaline/core/vec3.h"
#include "opaline/diffusion/radial_table.h"
#include "opaline/diffusion/reduced_medium.h"

namespace opaline {

/// Light as a source along its refracted ray, and its mirror image in a plane through entry and exit (Frisvad,
/// Hachisuka & Kjeldsen 2014, Directional Dipole Model for Subsurface Scattering), in mean free paths. As published:
/// where it is negative it is taken as 0; it is not reciprocal, and does not keep energy (published_total).
struct DirectionalKernel {
  double eta = 1;
  double decay = 0;          ///< sigma_tr
  double extrapolation = 0;  ///< d_e = 2.131 D / sqrt(alpha')
  double image = 0;          ///< 2 A d_e, height of the virtual source
  double from_fluence = 0;   ///< C_phi
  double from_flux = 0;      ///< C_E
};

/// The kernel's mean over diffuse light on a plane, by quadrature when it is first asked for (some 3 ms).
class DirectionalMean {
 public:
  explicit DirectionalMean(const DirectionalKernel& kernel);
  ~DirectionalMean();

  /// What leaves of diffuse light as published: 1.19 at eta 1.5 and 1.31 at eta 1 without absorption, and .12 and
  /// .33 where nothing scatters.
  double published_total() const;
  /// Of integral 1.
  const RadialTable& table() const;

 private:
  struct State;
  const State& state() const;
  std::unique_ptr<State> state_;
};

/// The kernel with a factor that makes the total of diffuse light the exact albedo (half_space.h). What is asked for
/// without a direction is the mean over diffuse light.
struct DirectionalDipole {
  double mean_free_path = 0;  ///< 1/sigma_t', mm
  double total = 0;           ///< of diffuse light, exact
  DirectionalKernel kernel;
  std::shared_ptr<const DirectionalMean> mean;
};

/// A place where light enters or leaves.
struct DirectedPlace {
  Vec3d position, normal;  ///< mm; unit, outward
};

/// What leaves at `exit` per area, 1/mm^2, of a unit of flux that entered at `entry` from the direction
/// `towards_light` (unit, outside). Of the smooth boundary the way in is in the entered flux, as with all
/// profiles, and the way out in the exitance.
/// in    dot(towards_light, entry.normal) > 0
/// out   >= 0; where entry and exit are the same, or one is straight below the other, the modified normal is not
///       defined: the entry's own, or any at right angles
double directional_reflectance(const DirectionalDipole& profile, const DirectedPlace& entry,
                               const Vec3d& towards_light, const DirectedPlace& exit);
/// The share that leaves of light that entered a plane at this cosine outside; by quadrature.
double total_directional_reflectance(const DirectionalDipole& profile, double cosine);

/// For make_channel_profile (diffuse_profile.h).
DirectionalDipole make_profile(const ReducedMedium& medium, std::type_identity<DirectionalDipole>);
/// R_d(r) of diffuse light, 1/mm^2, per entered flux, r > 0 in mm.
double diffuse_reflectance_profile(const DirectionalDipole& profile, double r);
/// The share of the entered diffuse light that leaves within r, mm.
double diffuse_reflectance_within(const DirectionalDipole& profile, double r);
/// Of diffuse light.
double total_diffuse_reflectance(const DirectionalDipole& profile);
/// As that of ChannelProfile; by the table.
double sample_diffusion_distance(const DirectionalDipole& profile, double beyond);
/// As that of ChannelProfile; by bisection.
double sample_chord_sphere_radius(const DirectionalDipole& profile, double u, double v);
/// sigma_tr, 1/mm.
double slowest_decay(const DirectionalDipole& profile);

}  // namespace opaline
