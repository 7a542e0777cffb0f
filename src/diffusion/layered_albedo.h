// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "diffusion/reduced_medium.h"

namespace opaline {

/// Total diffuse reflectance per transmitted flux of diffuse light, of a stack of isotropically scattering layers behind
/// a smooth boundary, and in front of another one if the last layer is finite. Layers do not reflect light between each other.
/// in    layers from the surface inwards, at least one; eta, inside over outside, > 0
/// out   [0, 1]; error below 2e-5 (test_layered_albedo)
/// from  van de Hulst 1980, Multiple Light Scattering, sec. 4 (adding and doubling); derived in src/diffusion/README.md
double layered_albedo(std::span<const FlatLayer> layers, double eta);

}  // namespace opaline
