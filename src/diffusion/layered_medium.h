// SPDX-License-Identifier: GPL-3.0-or-later
// Diffusion in a stack of flat layers, and the homogeneous medium closest to it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "diffusion/reduced_medium.h"
#include "opaline/scene.h"

namespace opaline {

/// Radiant exitance of a beam entering along the normal, over its transmitted flux: Hankel transform of
/// R_d(r) at a wave number, 1/length; at 0, the total. Solves -(D phi')' + (sigma_a + D k^2) phi = Q with the
/// boundary condition of `mismatch` on both sides, and the first collisions of the beam as Q.
/// in    layers: at least one; mismatch: A of the boundary, boundary_mismatch(eta)
double layered_exitance(std::span<const FlatLayer> layers, double mismatch, double wave_number);

/// Layers of a medium, one channel, 1/mm and mm; textured ones by their mean thickness.
std::vector<FlatLayer> flat_layers(const Medium& medium, std::size_t channel);

/// Homogeneous half space of the same total exitance, and the same wave number with half of it: a radial
/// profile of its reflectance and width. Thickness and fit are the defaults.
ReducedMedium equivalent_medium(std::span<const FlatLayer> layers, double eta);

}  // namespace opaline
