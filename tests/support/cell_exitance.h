// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance of cells, as random walks or the diffusion equation compute it.
#pragma once

#include <vector>

#include "methods/volume/volume_state.h"
#include "methods/volume_diffusion/volume_diffusion_state.h"

namespace opaline::test {

/// in    body: prepared by Method::volume or volume_diffusion
/// out   one a sample, bounced light included
inline std::vector<RgbF> cell_exitance(const Body& body) {
  if (body.plan.method == Method::volume) return volume_state(body).exitance.value.exitance;
  const VolumeDiffusionState& state = volume_diffusion_state(body);
  std::vector<RgbF> exitance = state.direct.value.exitance;
  for (std::size_t i = 0; i < state.bounced.value.exitance.size(); ++i)
    exitance[i] += state.bounced.value.exitance[i];
  return exitance;
}

/// Standard error of that under the lights alone.
inline std::vector<RgbF> cell_error(const Body& body) {
  return body.plan.method == Method::volume ? volume_state(body).exitance.value.error
                                            : volume_diffusion_state(body).direct.value.error;
}

}  // namespace opaline::test
