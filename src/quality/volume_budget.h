// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of volume_diffusion for a CPU time.
#pragma once

#include "quality/time_budget.h"

namespace opaline {

/// fit_budget for volume_diffusion: replaces the scene's cell_size, without an edit of the session to it.
TimeBudget fit_cells(Session& session, Scene& scene, double seconds, const FinishPicture& finish,
                     Monitor* monitor);

}  // namespace opaline
