// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/body_cloud_error.h"

#include <array>
#include <cmath>

#include "exitance/cloud_error.h"
#include "lights/light.h"
#include "methods/hierarchical/hierarchical_state.h"

namespace opaline {
namespace {

// Few rays: more do not differ by half of the light by chance (shadow_edges.cpp).
constexpr int kFewRays = 8;

/// Light fractions of the light entering, per channel.
struct LightShares {
  std::array<float, 3> shifted{};  ///< LightTransfer::edge_shift of all lights, as far as it is due to chance
  std::array<float, 3> from_points{};  ///< from lights without area
};

LightShares light_shares(const Body& body, const World& world, const Scene& scene) {
  const std::vector<Light> lights = recentred_lights(scene, world);  // as the weights are
  std::array<double, 3> shift{}, points{}, sum{};
  for (std::size_t l = 0; l < body.transfers.size(); ++l) {
    const LightTransfer& transfer = body.transfers[l];
    double light = 0;
    for (std::size_t i = 0; i < transfer.weights.size(); ++i)
      light += double(body.surface.samples[i].area) * double(transfer.weights[i]);
    const bool is_point = is_delta(lights[l]),
               chance = !is_point && shadow_rays(lights[l], scene.settings.light_samples) < kFewRays;
    const Rgb colour = emission(lights[l]);
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] += colour[c] * light;
      shift[c] += chance ? colour[c] * light * transfer.edge_shift : 0;
      points[c] += is_point ? colour[c] * light : 0;
    }
  }
  LightShares shares;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(sum[c] > 0)) continue;
    shares.shifted[c] = float(std::abs(shift[c]) / sum[c]);
    shares.from_points[c] = float(points[c] / sum[c]);
  }
  return shares;
}

}  // namespace

CloudError body_cloud_error(const Body& body, const World& world, const Scene& scene) {
  const HierarchicalState& state = hierarchical_state(body);
  const Settings& settings = scene.settings;
  const LightShares shares = light_shares(body, world, scene);
  CloudError error = tell_cloud_error(
      {state.octree(), state.kernel(), state.kernels.value.wider, settings.evaluator, settings.tolerance,
       settings.laboratory.max_solid_angle, settings.laboratory.instruction_set, shares.from_points});
  error.light_shift = shares.shifted;
  return error;
}

}  // namespace opaline
