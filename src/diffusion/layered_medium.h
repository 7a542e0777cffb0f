// SPDX-License-Identifier: GPL-3.0-or-later
// Diffusion in a stack of flat layers, and the homogeneous medium closest to it.
#pragma once

#include <limits>
#include <span>

#include "diffusion/reduced_medium.h"

namespace opaline {

/// One layer, from the surface inwards; isotropic scattering, index-matched to its neighbours.
struct FlatLayer {
  double sigma_a = 0, sigma_s_prime = 0;                       ///< 1/length
  double thickness = std::numeric_limits<double>::infinity();  ///< >= 0; infinite in the last layer only
};

/// Radiant exitance of a beam entering along the normal, over its transmitted flux: Hankel transform of
/// R_d(r) at a wave number, 1/length; at 0, the total. Solves -(D phi')' + (sigma_a + D k^2) phi = Q with the
/// boundary condition of `mismatch` on both sides, and the first collisions of the beam as Q.
/// in    layers: at least one; mismatch: A of the boundary, boundary_mismatch(eta)
double layered_exitance(std::span<const FlatLayer> layers, double mismatch, double wave_number);

/// Homogeneous half space of the same total exitance, and the same wave number with half of it: a radial
/// profile of its reflectance and width. Thickness and fit are the defaults.
ReducedMedium equivalent_medium(std::span<const FlatLayer> layers, double eta);

}  // namespace opaline
