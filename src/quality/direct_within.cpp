// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/stopwatch.h"
#include "quality/picture_cost.h"
#include "quality/time_budget.h"

namespace opaline {
namespace {

constexpr double kTrialPixels = 96 * 96;

/// CPU of a pass, and of the noise-free layers, s.
struct PassCost {
  double pass = 0, layers = 0;
};

}  // namespace

DirectResult direct_within(const PrecomputeInput& input, double seconds, const FinishPicture& finish) {
  const Stopwatch watch;
  const auto spent = [&watch] { return watch.cost({}).cpu_seconds; };
  const std::size_t per_pass = entry_samples_per_pass(input.scene.film),
                    most = input.scene.settings.entry_samples.value_or(SIZE_MAX / 2);
  Scene scene = input.scene;
  DirectState state;
  PassCost cost;
  const auto go_on = [&](std::size_t passes) {
    scene.settings.entry_samples = std::min((state.passes + passes) * per_pass, most);
    const std::size_t first = state.passes;
    const double start = spent();
    double end = start;
    DirectResult result = render_direct({scene, input.world, input.rays, input.plan, input.monitor}, state,
                                        [&](const DirectState&) { end = spent(); });
    if (state.passes > first) cost = {(end - start) / double(state.passes - first), spent() - end};
    return result;
  };
  DirectResult result = go_on(1);
  const double finishing = finishing_cost(thinned(result.picture.image, kTrialPixels), scene.film, finish);
  // First half of the estimated time, then the rest: a single pass is a poor estimate of the cost.
  for (const double share : {0.5, 1.0}) {
    const double left = kPlannedShare * seconds - spent() - finishing - cost.layers;
    const auto passes = std::size_t(std::max(0.0, share * left / cost.pass));
    if (passes == 0 || state.passes * per_pass >= most) break;
    const std::size_t before = state.passes;
    result = go_on(passes);
    if (state.passes < before + passes) break;  // error threshold reached
  }
  return result;
}

}  // namespace opaline
