// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/automatic/automatic_method.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/scene_properties.h"
#include "subsurface/plan_samples.h"

namespace opaline {
namespace {

/// Part of the scene that names hierarchical evaluation for a body; empty: none, or its medium is
/// heterogeneous.
const char* named_by_scene(const Scene& scene, const BodyPlan& body) {
  const Medium& medium = scene.media[body.medium];
  if (varies_inside(medium)) return "";
  if (medium.profile) return "the scene sets its profile";
  if (scene.settings.evaluator != EvaluatorKind::automatic) return "the scene sets the evaluator";
  return "";
}

}  // namespace

void AutomaticMethod::plan(const PlanningInput& input, BodyPlan& body,
                           std::vector<std::string>& warnings) const {
  body.reason_against_method = named_by_scene(input.scene, body);
  if (is_too_large_for_layers(input.scene, input.world, input.fewest_samples, body))
    body.reason_against_method = fmt::format(
        "cells as small as its layers require would exceed {:.2g} million or settings.max_samples",
        kMostCells / 1e6);
  body.method = body.reason_against_method.empty() ? Method::volume_diffusion : Method::hierarchical;
  method_of(body.method).plan(input, body, warnings);
}

double AutomaticMethod::samples_with_shadow_rays(const Plan& plan) const {
  double samples = 0;
  for (const Method method : {Method::volume_diffusion, Method::hierarchical})
    if (std::ranges::find(plan.groups, method, &BodyPlan::method) != plan.groups.end())
      samples = std::max(samples, method_of(method).samples_with_shadow_rays(plan));
  return samples;
}

}  // namespace opaline
