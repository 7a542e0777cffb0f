// SPDX-License-Identifier: GPL-3.0-or-later
// `lambert`: diffuse reflection at the hit, the limit of a vanishing mean free path and the floor of all
// costs.
#pragma once

#include "subsurface/method.h"

namespace opaline {

class LambertMethod : public SubsurfaceMethod {
 public:
  bool needs_samples() const override { return false; }
  bool spreads_light() const override { return false; }
  MethodLayers layers() const override { return {}; }
  bool has_model() const override { return false; }
  double samples_with_shadow_rays(const Plan&) const override { return 0; }
  double seconds_of_pixel(const Scene&, const Lighting& lighting) const override {
    return kSecondsOfShadowRay * lighting.rays;
  }
  std::string shading_stage(const Scene&) const override { return "lambert"; }
};

}  // namespace opaline
