// SPDX-License-Identifier: GPL-3.0-or-later
// `image_space`: a radial profile, summed over an octree of the points seen from the lights. For objects in
// motion: nothing is prepared on the mesh, and nothing survives its motion.
#pragma once

#include "subsurface/method.h"

namespace opaline {

class ImageSpaceMethod : public SubsurfaceMethod {
 public:
  bool needs_samples() const override { return false; }
  bool needs_bodies() const override { return true; }
  bool needs_transmitted_light() const override { return false; }
  MethodLayers layers() const override { return {}; }
  void plan(const PlanningInput& input, BodyPlan& body, std::vector<std::string>& warnings) const override;
  BodyMemory memory(const PlanningInput& input, const BodyPlan& body) const override;
  double seconds(const Scene& scene, const BodyPlan& body, const Lighting& lighting) const override;
  double seconds_of_pixel(const Scene&, const Lighting& lighting) const override;
  double samples_with_shadow_rays(const Plan&) const override { return 0; }
  std::string shading_stage(const Scene&) const override { return "hierarchical, from views of the lights"; }
  const char* stage() const override { return "light views"; }
  void prepare(BodyStages& stages) const override;
  StageKey direct_key(const Body& body) const override;
  std::unique_ptr<Field> field(const RenderInput& input, const Body& body) const override;
};

}  // namespace opaline
