// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of the diffusion equation inside one body and its solutions.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "methods/volume/cell_field.h"
#include "methods/volume/fit_cells.h"
#include "volume/volume_diffusion.h"
#include "volume/volume_exitance.h"

namespace opaline {

struct VolumeDiffusionState : MethodState {
  static constexpr Method kMethod = Method::volume_diffusion;
  StageResult<std::vector<std::uint32_t>> opaque;  ///< opaque_inside, indices into World::meshes
  StageResult<std::shared_ptr<const VolumeDiffusion>> cells;
  ReusedWeights weights;
  StageResult<std::shared_ptr<const NearestSample>> nearest;
  StageResult<VolumeExitance> direct,
      bounced;  ///< from lights, and from other surfaces; bounced: key of zeros if none
  std::shared_ptr<const CellFit> fit;  ///< fit of both; null while light of `seen` is gathered
  CellMeans seen;                      ///< exitance on gathered rays
};

/// in    body: prepared by Method::volume_diffusion
const VolumeDiffusionState& volume_diffusion_state(const Body& body);

}  // namespace opaline
