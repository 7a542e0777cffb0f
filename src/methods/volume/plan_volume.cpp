// SPDX-License-Identifier: GPL-3.0-or-later
// Memory, time and stages of `volume`.
#include <fmt/format.h>

#include <algorithm>

#include "methods/volume/volume_method.h"
#include "methods/volume/walk_input.h"
#include "volume/walk_memory.h"

namespace opaline {

BodyMemory VolumeMethod::memory(const PlanningInput& input, const BodyPlan& body) const {
  // Bytes, fitted to bench_plan: per sample; its search structure, fits and exitance; per channel, counts of
  // a pass's chunks; per light, sums.
  constexpr std::size_t kSample = 191, kWalkedCell = 300, kWalkedChannel = 64, kWalkSums = 24;
  return {
      .kept = body.samples * (kSample + kWalkedCell + 6 * kWalkedChannel + input.lights.size() * kWalkSums),
      .temporary = double(expected_walk_bytes(input.world, body.meshes,
                                              walked_mean_free_path(input.scene, input.world, body)))};
}

double VolumeMethod::seconds(const Scene& scene, const BodyPlan& body, const Lighting& lighting) const {
  constexpr double kWalk = 1e-5;
  constexpr double kSmallestWalks = 32;  // a sample, before an error is estimated
  return double(body.samples) * kWalk * 3 * std::clamp(lighting.lights, 1., 4.) *
         (scene.settings.until_error ? kSmallestWalks : double(kDefaultWalks));
}

std::string VolumeMethod::light_stage(const Scene& scene, std::span<const Light>) const {
  const Settings& settings = scene.settings;
  const std::string reentry = settings.reenter ? "; with re-entry" : "; without re-entry (settings.reenter)";
  if (settings.until_error)
    return fmt::format("random walks, until the noise of the cells is {:.3g} %",
                       100 * *settings.until_error) +
           reentry;
  return fmt::format("random walks, {} per sample, channel and light", kDefaultWalks) + reentry;
}

}  // namespace opaline
