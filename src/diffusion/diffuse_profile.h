// SPDX-License-Identifier: GPL-3.0-or-later
// Radial diffuse reflectance profile of a scene's medium, per channel.
#pragma once

#include <array>
#include <variant>

#include "diffusion/better_dipole.h"
#include "diffusion/dipole.h"
#include "diffusion/directional_dipole.h"
#include "diffusion/multipole.h"
#include "diffusion/normalized_diffusion.h"
#include "diffusion/tabulated.h"
#include "opaline/scene.h"

namespace opaline {

/// One channel; monostate: no scattering (sigma_s' = 0), and the diffuse part is exactly 0. A kind of profile
/// is a file defining the six functions up to `slowest_decay`, and `Kind make_profile(const ReducedMedium&,
/// std::type_identity<Kind>)`; a missing one does not compile. In the order of ProfileKind.
using ChannelProfile = std::variant<std::monostate, Dipole, NormalizedDiffusion, BetterDipole,
                                    TabulatedProfile, Multipole, DirectionalDipole>;

/// The profile of a kind; monostate for a medium without scattering.
ChannelProfile make_channel_profile(ProfileKind kind, const ReducedMedium& medium);

/// R_d(r), 1/mm^2, per transmitted flux, r > 0 in mm.
double diffuse_reflectance_profile(const ChannelProfile& profile, double r);
/// Fraction of the transmitted flux leaving within r, mm: the integral of 2 pi r' R_d(r').
double diffuse_reflectance_within(const ChannelProfile& profile, double r);
/// Total diffuse reflectance per transmitted flux, [0, 1].
double total_diffuse_reflectance(const ChannelProfile& profile);

/// Distance beyond which the fraction `beyond` of the profile's total leaves: density 2 pi r R_d(r) / total
/// for uniform `beyond`.
/// in    beyond in (0, 1]; a scattering profile
/// out   mm, finite, >= 0; relative error of the fraction under 1e-12 down to beyond = 1e-15
/// from  normalized diffusion: Golubev's closed form; dipole: each source is z exp(-sigma_tr (d - z)) / d
///       beyond d, inverted by Lambert's W; the remainder of `beyond` within its source is reused
double sample_diffusion_distance(const ChannelProfile& profile, double beyond);

/// Radius of a sphere around a point with random chords (isotropic, uniform) that intersect a surface element
/// at distance r with the density R_d(r) / (2 total) per area, for any orientation: density -pi R^2 R_d'(R) /
/// total of R.
/// in    u in (0, 1), v in (0, 1): independent
/// from  expected intersections of an area dA inside a ball by such a chord: dA / (2 pi R^2) (Crofton); the
///       line sampling of Walter et al. 2012, Bidirectional Lightcuts, builds on it
double sample_chord_sphere_radius(const ChannelProfile& profile, double u, double v);

/// Decay rate of the profile at large distances, 1/mm.
double slowest_decay(const ChannelProfile& profile);

/// True if the profile models the other face of a plate (Multipole). Other profiles treat a point of the far
/// face by its straight-line distance.
bool has_far_side(const ChannelProfile& profile);
/// Radiant exitance on the far face of a plate per unit of transmitted flux, 1/mm^2, at the straight-line
/// distance s, mm: T(r) at s^2 = thickness^2 + r^2, and T(0) for s < thickness. R_d(s) for profiles without a
/// far side.
double far_side_profile(const ChannelProfile& profile, double distance);
/// Fraction of the transmitted flux leaving through the other face, `thickness` away in mm, within r along
/// the plate.
double diffuse_transmittance_within(const ChannelProfile& profile, double r, double thickness);
/// At any distance.
double total_diffuse_transmittance(const ChannelProfile& profile, double thickness);

/// 1 - alpha' of the medium with this total: relative error in 1 - alpha' below 1e-12. total in [0, 1], of a
/// half space.
double invert_albedo(ProfileKind kind, double total, double eta);

/// 1/sigma_t' of a medium with this 1/sigma_t, 1 - alpha' and mean cosine g.
double reduced_mean_free_path(double subsurface_radius, double absorbed, double g);

/// Precomputed properties of a medium for rendering.
struct DiffuseProfile {
  std::array<ChannelProfile, 3> channels;
  Rgb mean_free_path{};          ///< 1/sigma_t'; 0 for a medium without scattering and absorption
  Rgb diffuse_mean_free_path{};  ///< 1/sigma_tr, length of decay far inside; infinite without absorption
  Rgb total{};                   ///< total diffuse reflectance per transmitted flux
  double eta = 1;
  double average_reflectance = 0;  ///< F_bar, from outside
  bool translucent = false;        ///< some channel scatters
  bool has_far_side = false;       ///< true if some channel has a far side
};

/// unit: of all its lengths, mm.
DiffuseProfile make_diffuse_profile(const Medium& medium, double unit = 1);

/// Integral over r < h of 2 pi r R_d(r) (1 - w(r/h)), w the near-field weight below: the near part of the
/// total.
double near_field_reflectance(const ChannelProfile& profile, double h);

/// w(t) = t^3 (10 - 15 t + 6 t^2) below 1, else 1: the far kernel is R_d(r) w(r/h).
template <class T>
T far_weight(T t) {
  return t >= T(1) ? T(1) : t * t * t * (T(10) + t * (T(-15) + T(6) * t));
}

/// Density of the near field's light over t = r/h, up to a constant: t R_d(t h) (1 - w(t)).
inline double near_ring(const ChannelProfile& profile, double h, double t) {
  return t * diffuse_reflectance_profile(profile, t * h) * (1 - far_weight(t));
}

}  // namespace opaline
