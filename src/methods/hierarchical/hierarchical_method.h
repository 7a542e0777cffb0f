// SPDX-License-Identifier: GPL-3.0-or-later
// `hierarchical`: a radial profile, summed over an octree of samples (Jensen & Buhler 2002).
#pragma once

#include "subsurface/method.h"

namespace opaline {

class HierarchicalMethod : public SubsurfaceMethod {
 public:
  bool may_use_surface_cache() const override { return true; }
  void plan(const PlanningInput& input, BodyPlan& body, std::vector<std::string>& warnings) const override;
  BodyMemory memory(const PlanningInput& input, const BodyPlan& body) const override;
  double seconds(const Scene& scene, const BodyPlan& body, const Lighting& lighting) const override;
  double samples_with_shadow_rays(const Plan& plan) const override;
  void list_stages(const Scene& scene, std::vector<std::string>& stages) const override;
  std::string shading_stage(const Scene&) const override { return "hierarchical"; }
  const char* stage() const override { return "octree"; }
  void prepare(BodyStages& stages) const override;
  StageKey direct_key(const Body& body) const override;
  StageKey bounced_key(const Body& body) const override;
  void remove_bounced(BodyStages& stages) const override;
  void add_bounced(BodyStages& stages, std::span<const RgbF> bounced, const StageKey& key) const override;
  std::unique_ptr<MethodState> direct_state(const BodyStages& stages) const override;
  bool finish(BodyStages& stages) const override;
  std::span<const RgbF> irradiance(const Body& body) const override;
  std::vector<RgbF> exitance_at(const Body& body, std::span<const Query> points,
                                const Settings& settings) const override;
  std::unique_ptr<Field> field(const RenderInput& input, const Body& body) const override;
};

}  // namespace opaline
