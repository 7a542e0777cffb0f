// SPDX-License-Identifier: GPL-3.0-or-later
// Reflection and transmission of a plate: the reference by random walks, and the result of a radial profile.
#pragma once

#include <cstddef>

#include "diffusion/diffuse_profile.h"

namespace opaline {

/// Fractions of the light transmitted into one face: reflected there, and transmitted through the other face.
/// The rest is absorbed.
struct SlabLight {
  double back = 0, through = 0;
};

/// An infinite plate in diffuse light, by random walks with isotropic scattering and Fresnel reflection at
/// both faces; standard error of each fraction below 0.5 / sqrt(walks).
/// in    reduced_albedo in [0, 1]; optical_thickness in mean free paths, > 0; eta, inside over outside, > 0
SlabLight slab_by_walks(double reduced_albedo, double optical_thickness, double eta, std::size_t walks);

/// The same by the profile, thickness in mm: a point of the far face is lit through the plate.
SlabLight slab_by_profile(const ChannelProfile& profile, double thickness);

}  // namespace opaline
