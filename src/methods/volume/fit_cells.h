// SPDX-License-Identifier: GPL-3.0-or-later
// Fit of the means over a body's cells, with weights cached for later fits of the same samples.
#pragma once

#include <memory>
#include <span>

#include "exitance/evaluate.h"
#include "subsurface/body_stages.h"
#include "volume/cell_fit.h"

namespace opaline {

using ReusedWeights = StageResult<std::shared_ptr<const CellWeights>>;

/// in    means, errors: one per sample of the body; weights: of earlier fits, replaced if the samples
///       changed; unused if no later fit is expected
std::shared_ptr<const CellFit> fit_cells(BodyStages& stages, ReusedWeights& weights,
                                         std::span<const RgbF> means, std::span<const RgbF> errors);

/// Values of a fit at points, world space and unit.
std::vector<RgbF> fit_at(const CellFit& fit, std::span<const Query> points);

}  // namespace opaline
