// SPDX-License-Identifier: GPL-3.0-or-later
// `volume_diffusion`: the diffusion equation, solved on cells inside the bodies.
#pragma once

#include "subsurface/method.h"

namespace opaline {

class VolumeDiffusionMethod : public SubsurfaceMethod {
 public:
  bool follows_textures_inside(bool is_closed) const override { return is_closed; }
  bool uses_radial_profile() const override { return false; }
  std::optional<double> expected_error(const BodyModel& model) const override {
    return model.expected_error_of_diffusion;
  }
  bool supports_reentry() const override { return true; }
  int gathered_rays() const override { return 8; }
  void plan(const PlanningInput& input, BodyPlan& body, std::vector<std::string>& warnings) const override;
  BodyMemory memory(const PlanningInput& input, const BodyPlan& body) const override;
  double seconds(const Scene& scene, const BodyPlan& body, const Lighting& lighting) const override;
  std::string body_stage(const BodyPlan& body) const override;
  std::string shading_stage(const Scene&) const override { return "cells, interpolated"; }
  const char* stage() const override { return "diffusion"; }
  void prepare(BodyStages& stages) const override;
  StageKey direct_key(const Body& body) const override;
  StageKey bounced_key(const Body& body) const override;
  void remove_bounced(BodyStages& stages) const override;
  void add_bounced(BodyStages& stages, std::span<const RgbF> bounced, const StageKey& key) const override;
  void add_for_gathering(BodyStages& stages, std::span<const RgbF> bounced) const override;
  std::unique_ptr<MethodState> direct_state(const BodyStages& stages) const override;
  bool finish(BodyStages& stages) const override;
  std::vector<std::string> warnings(const Body& body, double unit) const override;
  std::vector<RgbF> exitance_at(const Body& body, std::span<const Query> points,
                                const Settings& settings) const override;
  std::unique_ptr<Field> field(const RenderInput& input, const Body& body) const override;
};

}  // namespace opaline
