// SPDX-License-Identifier: GPL-3.0-or-later
// `preintegrated`: each hit as on a ball of the local curvature, without a precompute of light.
#pragma once

#include "subsurface/method.h"

namespace opaline {

class PreintegratedMethod : public SubsurfaceMethod {
 public:
  bool needs_samples() const override { return false; }
  bool needs_bodies() const override { return true; }
  bool needs_transmitted_light() const override { return false; }
  bool uses_radial_profile() const override { return false; }
  MethodLayers layers() const override { return {}; }
  bool has_model() const override { return false; }
  double samples_with_shadow_rays(const Plan&) const override { return 0; }
  double seconds_of_pixel(const Scene&, const Lighting& lighting) const override {
    return kSecondsOfShadowRay * lighting.rays;
  }
  std::string shading_stage(const Scene&) const override { return "preintegrated diffusion by curvature"; }
  const char* stage() const override { return "curvature"; }
  void prepare(BodyStages& stages) const override;
  StageKey direct_key(const Body& body) const override;
  std::unique_ptr<Field> field(const RenderInput& input, const Body& body) const override;
};

}  // namespace opaline
