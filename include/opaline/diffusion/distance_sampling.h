// SPDX-License-Identifier: GPL-3.0-or-later
// Random distances with the density of a radial profile.
#pragma once

#include "opaline/diffusion/diffuse_profile.h"

namespace opaline {

/// Distance beyond which a share `beyond` of the profile's total leaves: density 2 pi r R_d(r) / total when
/// `beyond` is uniform.
/// in    beyond in (0, 1]; a profile that scatters
/// out   mm, finite, >= 0; relative
/// error of the share under 1e-12 down to beyond = 1e-15
/// from  normalized diffusion: Golubev's closed form;
/// dipole: each source is z exp(-sigma_tr (d - z)) / d beyond d,
///       inverted by Lambert's W; the rest of `beyond` within its source is used again
double sample_diffusion_distance(const ChannelProfile& profile, double beyond);

/// Radius of a sphere around a point such that a random chord of it (isotropic, uniform) meets a surface
/// element at distance r with density R_d(r) / (2 total) per area, whatever the element's orientation:
/// density -pi R^2 R_d'(R) / total of R.
/// in    u in (0, 1), v in (0, 1): independent
/// from  expected crossings
/// of an area dA inside a ball by such a chord: dA / (2 pi R^2) (Crofton); the line sampling
///       of Walter et al. 2012, Bidirectional Lightcuts, builds on it
double sample_chord_sphere_radius(const ChannelProfile& profile, double u, double v);

}  // namespace opaline
