// SPDX-License-Identifier: GPL-3.0-or-later
// Fluence around an isotropic point source in an infinite, isotropically scattering medium (g = 0): exact, by
// diffusion, and by random walks.
#pragma once

#include "transport/laboratory.h"
#include "transport/medium.h"

namespace opaline {

/// kappa / sigma_t of the exact decay exp(-kappa r) far from all sources: the root in (0, 1] of albedo
/// atanh(kappa) = kappa, for albedo in (0, 1]; 0 at 1.
/// in    absorbed = 1 - albedo in [0, 1): avoids cancellation for small values
/// from  Case & Zweifel 1967, Linear Transport Theory, sec. 4.4; relative error below 1e-13
double decay_constant(double absorbed);

/// Fluence at the distance r, 1/mm^2, of a source of power 1: the discrete mode and the integral over the
/// continuous ones.
/// in    isotropically scattering medium: g is ignored; sigma_t > 0; r > 0 in mm
/// out   relative error below 1e-8; without scattering the Beer-Lambert law alone
/// from  Case & Zweifel 1967, sec. 4.5; derived in src/transport/README.md
double point_source_fluence(const HomogeneousMedium& medium, double r);

/// Classical diffusion: 3 sigma_t' exp(-sigma_tr r) / (4 pi r), sigma_tr = sqrt(3 sigma_a sigma_t').
double diffusion_point_fluence(const HomogeneousMedium& medium, double r);

/// Grosjean's approximation: uncollided light exactly, and diffusion from the first collisions with D = (2
/// sigma_a + sigma_s') / (3 sigma_t'^2).
/// from  Grosjean 1956; d'Eon & Irving 2011, A Quantized-Diffusion Model for Rendering Translucent Materials
double grosjean_point_fluence(const HomogeneousMedium& medium, double r);

}  // namespace opaline
