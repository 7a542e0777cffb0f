// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/error_budget.h"

#include <fmt/format.h>

#include <algorithm>

namespace opaline {
namespace {

constexpr std::size_t kFactor = 16, kMostSamples = 4'000'000;
constexpr int kMostLightSamples = 65536;
constexpr int kEvenLight = 1024;  // shadow rays with noise far below the interpolation error

using Overrides = std::vector<std::string>;

Overrides operator+(Overrides a, const Overrides& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Tree evaluator of the scene's images, without the interpolation of a surface cache.
std::string tree_of(EvaluatorKind evaluator) {
  return evaluator == EvaluatorKind::classic ? "classic" : "dual_tree";
}

}  // namespace

// Isolates the components. Samples and near field are compared at a tolerance small enough not to hide them.
// Samples are compared at an equal total number of shadow rays: otherwise more samples would also average out
// more noise of the irradiance.
std::vector<BudgetPart> error_budget(std::size_t planned_samples, const Settings& settings) {
  if (planned_samples == 0) return {};
  const std::size_t most = std::max(std::min(kFactor * planned_samples, kMostSamples), 2 * planned_samples);
  const std::string many = std::to_string(most);
  const std::string factor = fmt::format("{:.3g}", double(most) / double(planned_samples));
  const int light_samples = int(std::min<long>(long(kFactor) * settings.light_samples, kMostLightSamples));
  const std::string tree = tree_of(settings.evaluator);
  const Overrides many_rays{fmt::format("settings.light_samples={}", light_samples)};
  const int even = std::max(light_samples, kEvenLight);
  const Overrides even_light{fmt::format("settings.light_samples={}", even)};
  const Overrides lone{"settings.bounces=0"};  // light between shapes belongs to neither
  const Overrides fine{"settings.evaluator=dual_tree", "settings.tolerance=0.001"};
  const Overrides dense = fine + Overrides{"settings.samples=" + many, "settings.max_samples=" + many};
  return {
      {"sampling", fmt::format("{} times the samples", factor), fine + many_rays, dense},
      {"irradiance",
       fmt::format("{} instead of {} shadow rays per area light", light_samples, settings.light_samples),
       {},
       many_rays},
      {"hierarchy",
       fmt::format("the exact sum instead of the octree ({})", tree),
       {"settings.evaluator=" + tree},
       {"settings.evaluator=brute_force"}},
      {"near field", fmt::format("near_field=false, both with {} times the samples", factor), dense,
       dense + Overrides{"settings.laboratory.near_field=false"}},
      {"interpolation",
       fmt::format("the octree at each point instead of the surface cache, both with {} shadow rays", even),
       even_light + Overrides{"settings.evaluator=surface_cache"},
       even_light + Overrides{"settings.evaluator=dual_tree"}},
      {"model", "volume_diffusion instead of the radial profile, both without bounces", lone,
       lone + Overrides{"settings.method=volume_diffusion"}},
  };
}

}  // namespace opaline
