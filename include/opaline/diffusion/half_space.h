// SPDX-License-Identifier: GPL-3.0-or-later
// The exact albedo of a half space that scatters evenly behind a smooth boundary.
#pragma once

namespace opaline {

/// The share of diffuse light that comes back of what entered: total diffuse reflectance per entered flux.
/// in    absorbed = 1 - albedo in [0, 1]; eta, inside over outside, > 0
/// out   [0, 1]; relative error below 1e-9 for eta from .1 to 10; exactly 1 where absorbed is 0
/// from  Chandrasekhar 1960, Radiative Transfer, sec. 38 (the H function and diffuse reflection), with Fresnel's
///       reflection inside by a linear system over its quadrature points; derived in src/diffusion/README.md
double half_space_albedo(double absorbed, double eta);

}  // namespace opaline
