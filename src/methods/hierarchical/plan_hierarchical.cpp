// SPDX-License-Identifier: GPL-3.0-or-later
// Samples, memory, time and stages of `hierarchical`.
#include <fmt/format.h>

#include "methods/hierarchical/hierarchical_method.h"
#include "methods/hierarchical/surface_caches.h"
#include "scene/scene_properties.h"
#include "subsurface/light_distance.h"
#include "subsurface/plan_samples.h"

namespace opaline {
namespace {

// Bytes, fitted to bench_plan at 1 and 10 million samples: samples, weights and tree while its nodes are
// written; per further light, weights; with bounces; in needles, on a ring 1e5 times thinner than wide.
constexpr std::size_t kBytesOfSample = 205, kBytesOfLight = 4, kBytesOfBounces = 200;
constexpr double kBytesOfNeedle = 250;

/// Warns of a body thinner than its sample spacing.
void warn_of_thin_body(const BodyPlan& body, std::vector<std::string>& warnings) {
  const double thickness = body.thickness;
  if (!(thickness > 0 && thickness < body.spacing)) return;
  warnings.push_back(fmt::format(
      "{}: the mean thickness of {:.3g} mm is less than the sample spacing of {:.3g} mm, so samples cannot "
      "separate the two sides; use {:.2g} samples (settings.samples, settings.max_samples)",
      body.name, thickness, body.spacing, body.area / (thickness * thickness)));
}

std::string evaluation_stage(const Settings& settings) {
  const std::string promise = fmt::format("error below {:.3g} % of the exact sum", 100 * settings.tolerance);
  switch (settings.evaluator) {
    case EvaluatorKind::automatic:
      return "evaluation: dual tree at shading points, or a surface cache if that needs fewer points; " +
             promise;
    case EvaluatorKind::dual_tree:
      return "evaluation: dual tree at shading points; " + promise;
    case EvaluatorKind::surface_cache:
      return "evaluation: surface cache by dual tree; " + promise;
    case EvaluatorKind::classic:
      return fmt::format("evaluation: classic octree traversal, maximum solid angle {} sr",
                         settings.laboratory.max_solid_angle);
    case EvaluatorKind::brute_force:
      return "evaluation: exact sum (brute force)";
  }
  return "";
}

}  // namespace

void HierarchicalMethod::plan(const PlanningInput& input, BodyPlan& body,
                              std::vector<std::string>& warnings) const {
  choose_samples(input.scene, input.fewest_samples, body, warnings);
  warn_of_near_lights(input.scene, input.world, body, warnings);
  warn_of_thin_body(body, warnings);
}

BodyMemory HierarchicalMethod::memory(const PlanningInput& input, const BodyPlan& body) const {
  BodyMemory memory{.evaluated_samples = body.samples};
  memory.kept = body.samples * (kBytesOfSample + kBytesOfLight * input.lights.size() +
                                (bounces_of(input.scene) > 0 ? kBytesOfBounces : 0));
  if (input.scene.settings.evaluator == EvaluatorKind::surface_cache)
    memory.caches = expected_cache_places(input.scene, body, input.world) * kBytesOfPlace;
  memory.kept += std::size_t(needle_fraction(input.world, body) * double(body.samples) * kBytesOfNeedle);
  return memory;
}

double HierarchicalMethod::seconds(const Scene& scene, const BodyPlan& body, const Lighting& lighting) const {
  constexpr double kSample = 8e-6;        // placed, in the tree
  constexpr double kGather = 1.5e-5;      // light from other bodies at a sample
  constexpr double kGatherPlates = 1e-4;  // the same between plates: their profile is far slower
  constexpr double kGatherAlone = 4e-6;   // the same where there is one body
  const double others = body.model.profile.kind == ProfileKind::multipole ? kGatherPlates : kGather;
  const double gather = bounces_of(scene) == 0 ? 0 : scene.shapes.size() > 1 ? others : kGatherAlone;
  return double(body.samples) * (kSample + kSecondsOfShadowRay * lighting.rays + gather);
}

double HierarchicalMethod::samples_with_shadow_rays(const Plan& plan) const {
  double samples = 0;
  for (const BodyPlan& body : plan.groups) samples += double(body.samples);
  return samples;
}

void HierarchicalMethod::list_stages(const Scene& scene, std::vector<std::string>& stages) const {
  stages.push_back("octree");
  stages.push_back(evaluation_stage(scene.settings));
}

}  // namespace opaline
