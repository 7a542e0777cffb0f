// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of all bodies of volume_diffusion, and the bound of their model error.
#pragma once

#include <optional>

#include "bodies/plan.h"

namespace opaline {

/// Edge of the smallest cells of all bodies, mm; infinite without cells.
double smallest_cell(const Plan& plan);

/// Settings::cell_size for cells as small as the plan's: the smallest of all bodies, in their mean free paths.
double smallest_cell_size(const Plan& plan);

/// Bound of the model error of the worst body. None if a mesh is open, crossed by light almost without scattering, or too
/// large for cells.
std::optional<double> bounded_model_error(const Plan& plan);

}  // namespace opaline
