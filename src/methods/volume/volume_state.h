// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks of one body and their estimate.
#pragma once

#include <memory>
#include <vector>

#include "methods/volume/fit_cells.h"
#include "volume/volume_exitance.h"

namespace opaline {

struct VolumeState : MethodState {
  static constexpr Method kMethod = Method::volume;
  VolumeSums walks;                      ///< sums so far, of whole passes
  std::vector<StageKey> walk_keys;       ///< keys of the sources of the sums
  StageResult<VolumeExitance> exitance;  ///< estimate of these sums
  ReusedWeights weights;
  std::shared_ptr<const CellFit> fit;  ///< fit of the estimate, at any point
};

/// in    body: prepared by Method::volume
const VolumeState& volume_state(const Body& body);

}  // namespace opaline
