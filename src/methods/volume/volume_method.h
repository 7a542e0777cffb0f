// SPDX-License-Identifier: GPL-3.0-or-later
// `volume`: volumetric path tracing inside the bodies, the reference.
#pragma once

#include "subsurface/method.h"

namespace opaline {

class VolumeMethod : public SubsurfaceMethod {
 public:
  bool needs_transmitted_light() const override { return false; }
  bool follows_textures_inside(bool /*is_closed*/) const override { return true; }
  bool uses_radial_profile() const override { return false; }
  bool has_model() const override { return false; }
  bool supports_bounces() const override { return false; }
  bool separates_lights() const override { return false; }
  BodyMemory memory(const PlanningInput& input, const BodyPlan& body) const override;
  double seconds(const Scene& scene, const BodyPlan& body, const Lighting& lighting) const override;
  std::string light_stage(const Scene& scene, std::span<const Light> lights) const override;
  std::string shading_stage(const Scene&) const override { return "cells, interpolated"; }
  const char* stage() const override { return "random walks"; }
  void prepare(BodyStages& stages) const override;
  bool finish(BodyStages& stages) const override;
  std::vector<std::string> warnings(const Body& body, double unit) const override;
  std::vector<RgbF> exitance_at(const Body& body, std::span<const Query> points,
                                const Settings& settings) const override;
  std::unique_ptr<Field> field(const RenderInput& input, const Body& body) const override;
};

}  // namespace opaline
