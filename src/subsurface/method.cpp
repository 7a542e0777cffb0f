// SPDX-License-Identifier: GPL-3.0-or-later
#include "subsurface/method.h"

#include "scene/scene_properties.h"
#include "subsurface/plan_samples.h"

namespace opaline {

void SubsurfaceMethod::plan(const PlanningInput& input, BodyPlan& body,
                            std::vector<std::string>& warnings) const {
  choose_samples(input.scene, input.fewest_samples, body, warnings);
}

std::string SubsurfaceMethod::light_stage(const Scene& scene, std::span<const Light> lights) const {
  return irradiance_stage(scene, lights);
}

std::string SubsurfaceMethod::bounces_stage() const {
  return "bounces: light between shapes, one bounce, gathered at the samples and at 64 x 64 points of the "
         "image, more in corners";
}

bool gathers_light(const Scene& scene, const BodyPlan& body) {
  if (bounces_of(scene) > 0) return true;
  const Settings& settings = scene.settings;
  return settings.reenter && !settings.bounces && !scene.lights.empty() &&
         method_of(body.method).supports_reentry();
}

}  // namespace opaline
