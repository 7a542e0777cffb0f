// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/automatic/automatic_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "bodies/local_media.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

// CPU time of cells that is never too long, s, and its largest ratio to that of hierarchical evaluation.
constexpr double kShort = 4, kDearest = 4;

struct MethodPlan {
  BodyPlan body;
  std::vector<std::string> warnings;
};

MethodPlan planned_by(Method method, const PlanningInput& input, BodyPlan body) {
  MethodPlan result{std::move(body), {}};
  result.body.method = method;
  method_of(method).plan(input, result.body, result.warnings);
  return result;
}

/// Part of the scene that names hierarchical evaluation for a body; empty: none, or its medium is heterogeneous.
std::string named_by_scene(const Scene& scene, const BodyPlan& body) {
  const Medium& medium = scene.media[body.medium];
  if (varies_inside(medium)) return {};
  if (medium.profile) return "the scene sets its profile";
  if (scene.settings.evaluator != EvaluatorKind::automatic) return "the scene sets its evaluator";
  return {};
}

/// Reason against cells that are possible; empty: none.
std::string reason_by_cost(const PlanningInput& input, const BodyPlan& cells, const BodyPlan& tree) {
  if (varies_inside(input.scene.media[cells.medium])) return {};
  const Lighting lighting = lighting_of(input.scene);
  const double seconds = method_of(cells.method).seconds(input.scene, cells, lighting);
  const double least = method_of(tree.method).seconds(input.scene, tree, lighting);
  if (seconds < kShort || seconds < kDearest * least) return {};
  return fmt::format("the diffusion equation would take {:.2g} s of CPU instead of {:.2g} s", seconds, least);
}

}  // namespace

void AutomaticMethod::plan(const PlanningInput& input, BodyPlan& body,
                           std::vector<std::string>& warnings) const {
  MethodPlan chosen = planned_by(Method::volume_diffusion, input, body);
  std::string reason = named_by_scene(input.scene, body);
  if (chosen.body.method == Method::volume_diffusion) {
    MethodPlan tree = planned_by(Method::hierarchical, input, body);
    if (reason.empty()) reason = reason_by_cost(input, chosen.body, tree.body);
    if (!reason.empty()) chosen = std::move(tree);
  }
  if (!reason.empty()) chosen.body.reason_against_method = std::move(reason);
  body = std::move(chosen.body);
  warnings.insert(warnings.end(), chosen.warnings.begin(), chosen.warnings.end());
}

double AutomaticMethod::samples_with_shadow_rays(const Plan& plan) const {
  double samples = 0;
  for (const Method method : {Method::volume_diffusion, Method::hierarchical})
    if (std::ranges::find(plan.groups, method, &BodyPlan::method) != plan.groups.end())
      samples = std::max(samples, method_of(method).samples_with_shadow_rays(plan));
  return samples;
}

}  // namespace opaline
