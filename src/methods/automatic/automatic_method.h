// SPDX-License-Identifier: GPL-3.0-or-later
// `auto`: for each body, the diffusion equation or a radial profile.
#pragma once

#include "methods/volume_diffusion/volume_diffusion_method.h"

namespace opaline {

/// `volume_diffusion`, except for bodies that it does not suit: `hierarchical` evaluates those whose profile
/// or evaluator the scene sets, open meshes, bodies of too many mean free paths, and bodies whose layers require
/// more cells than the limit. The choice depends on bodies and media alone, not on camera, resolution or clock; in other frames,
/// on those of the reference frame.
class AutomaticMethod : public VolumeDiffusionMethod {
 public:
  void plan(const PlanningInput& input, BodyPlan& body, std::vector<std::string>& warnings) const override;
  double samples_with_shadow_rays(const Plan& plan) const override;
};

}  // namespace opaline
