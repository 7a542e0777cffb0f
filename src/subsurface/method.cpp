// SPDX-License-Identifier: GPL-3.0-or-later
#include "subsurface/method.h"

#include <variant>

#include "scene/scene_properties.h"
#include "subsurface/plan_samples.h"

namespace opaline {

namespace {

/// True for a built-in convex shape: no light enters it again.
bool is_convex(const Scene& scene, const BodyPlan& body) {
  if (body.meshes.size() != 1) return false;
  const auto& source = scene.shapes[body.meshes[0]].source;
  return std::holds_alternative<SphereShape>(source) || std::holds_alternative<BoxShape>(source) ||
         std::holds_alternative<SlabShape>(source);
}

}  // namespace

void SubsurfaceMethod::plan(const PlanningInput& input, BodyPlan& body,
                            std::vector<std::string>& warnings) const {
  choose_samples(input.scene, input.fewest_samples, body, warnings);
}

std::string SubsurfaceMethod::light_stage(const Scene& scene, std::span<const Light> lights) const {
  return irradiance_stage(scene, lights);
}

std::string SubsurfaceMethod::bounces_stage() const {
  return "bounces: light between shapes, gathered at the samples and at 64 x 64 points of the image, more in "
         "corners";
}

bool gathers_light(const Scene& scene, const BodyPlan& body) {
  if (bounces_of(scene) > 0) return true;
  const Settings& settings = scene.settings;
  return settings.reenter && !settings.bounces && !scene.lights.empty() && !is_convex(scene, body) &&
         method_of(body.method).supports_reentry();
}

bool leaves_out_reentry(const Scene& scene, const BodyPlan& body) {
  return !gathers_light(scene, body) && !is_convex(scene, body);
}

}  // namespace opaline
