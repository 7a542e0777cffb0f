// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of all bodies of volume_diffusion, and the bound of the model error.
#pragma once

#include <optional>

#include "bodies/plan.h"

namespace opaline {

/// Edge of the smallest cells of all bodies, mm; infinite without cells.
double smallest_cell(const Plan& plan);

/// Settings::cell_size for cells as small as the plan's: the smallest of all bodies, in their mean free paths.
double smallest_cell_size(const Plan& plan);

/// Bound of the model error of the worst body of volume_diffusion. None if one is open, crossed by light almost without
/// scattering, or by another method: the errors of radial profiles exceed the expected ones several times.
std::optional<double> bounded_model_error(const Plan& plan);

}  // namespace opaline
