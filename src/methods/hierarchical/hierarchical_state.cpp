// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/hierarchical_state.h"

#include <algorithm>
#include <utility>

#include "lights/light.h"
#include "subsurface/body_stages.h"

namespace opaline {

const HierarchicalState& hierarchical_state(const Body& body) {
  return state_of<HierarchicalState>(body);
}

HierarchicalState& hierarchical_state(Body& body) {
  return state_of<HierarchicalState>(body);
}

Octree gather_flux(std::span<const SurfaceSample> samples, std::span<const RgbF> irradiance) {
  std::vector<FluxSample> flux(samples.size());
  for (std::size_t i = 0; i < flux.size(); ++i) {
    const SurfaceSample& s = samples[i];
    flux[i] = {s.centroid, s.area, irradiance[i], s.normal};
  }
  return build_octree(std::move(flux));
}

void bound_far_side(HierarchicalState& state) {
  if (state.kernel().far_side != nullptr && state.octree().normal_cones.empty())
    bound_normals(state.tree.value);
}

void set_hierarchical_state(Body& body, std::vector<RgbF> irradiance, SplitKernel kernel) {
  auto& state = hierarchical_state(body);
  state.irradiance = std::move(irradiance);
  state.kernels.value.kernel = std::move(kernel);
  state.tree.value = gather_flux(body.surface.samples, state.irradiance);
  bound_far_side(state);
}

NearIrradiance near_irradiance(const Scene& scene) {
  const auto is_from_all_directions = [](const Light& light) {
    const LightExtent shape = extent(light);
    return !is_delta(light) && !shape.center && !shape.towards;
  };
  const NearIrradiance wanted = scene.settings.laboratory.near_irradiance;
  const bool is_soft = !scene.lights.empty() && std::ranges::all_of(scene.lights, is_from_all_directions);
  return wanted == NearIrradiance::mixed && is_soft ? NearIrradiance::samples : wanted;
}

SplitKernel body_kernel(const DiffuseProfile& profile, double spacing, const World& world,
                        const Scene& scene) {
  return make_split_kernel(profile, spacing, world.diagonal, scene.settings.laboratory.near_field,
                           near_irradiance(scene));
}

}  // namespace opaline
