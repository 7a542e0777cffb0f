// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/hierarchical_method.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <variant>

#include "diffusion/tabulated.h"
#include "exitance/cloud_error.h"
#include "exitance/evaluate.h"
#include "input/settings_table.h"
#include "lights/light.h"
#include "methods/hierarchical/hierarchical_state.h"
#include "methods/hierarchical/sample_field.h"
#include "methods/hierarchical/surface_caches.h"
#include "scene/scene_properties.h"
#include "stages/stage_codecs.h"

namespace opaline {
namespace {

// A few rays suffice; more change the light by less than half (shadow_edges.cpp).
constexpr int kFewRays = 8;

/// Fractions of the transmitted light, per channel.
struct LightShares {
  std::array<float, 3> shifted{};      ///< LightTransfer::edge_shift of all lights, its random part
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

/// in    body: with its transfers, tree and kernels
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

// Raise a stage's number when it computes other values from the same input (test_stage_versions).
constexpr std::uint64_t kKernelVersion = 4, kExitanceVersion = 10;

/// Builds the tree of the body's irradiance, or reads it from the cache.
ResultSource update_tree(BodyStages& stages, const StageKey& key) {
  auto& state = state_of<HierarchicalState>(stages.body);
  return stages.store.get(state.tree, key, OctreeCodec{stages.body.surface}, [&] {
    Octree tree = gather_flux(stages.body.surface.samples, state.irradiance);
    stages.store.work().nodes_built += tree.nodes.size();
    return tree;
  });
}

/// Reads the shapes of tabulated profiles from the cache before random walks would compute them, and keeps
/// computed ones.
void find_walked_profiles(BodyStages& stages) {
  if (!stages.store.has_cache()) return;
  for (const ChannelProfile& channel : stages.body.profile.channels) {
    const auto* profile = std::get_if<TabulatedProfile>(&channel);
    if (profile == nullptr || profile->mean_free_path == 0) continue;
    const WalkedMedium& walked = profile->medium;
    if (has_walked_table(walked)) continue;
    const StageKey key = walked_profile_key(walked);
    if (auto found = stages.store.find(key, WalkedProfileCodec{}))
      take_walked_table(walked, std::move(*found));
    else
      stages.store.keep(key, profile->shape->get().table, WalkedProfileCodec{});
  }
}

void update_kernels(BodyStages& stages) {
  const auto& [scene, world, rays, plan, monitor] = stages.input;
  const Body& body = stages.body;
  const Medium& medium = scene.media[body.plan.medium];
  const double spacing = body.surface.spacing();
  KeyBuilder key("kernel", kKernelVersion);
  add_profile(key, medium);
  key.add(spacing).add(world.diagonal).add(world.unit);
  key.add(settings_in_key(KeyedStage::kernel, scene)).add(near_irradiance(scene));
  stages.store.get(state_of<HierarchicalState>(stages.body).kernels, key.key(), [&] {
    find_walked_profiles(stages);
    return Kernels{body_kernel(body.profile, spacing, stages.input.world, stages.input.scene),
                   body_kernel(body.profile, kWiderField * spacing, stages.input.world, stages.input.scene)};
  });
}

StageKey exitance_key(const BodyStages& stages, const HierarchicalState& state) {
  KeyBuilder key("exitance", kExitanceVersion);
  key.add(state.tree.key).add(state.kernels.key);
  key.add(settings_in_key(KeyedStage::exitance, stages.input.scene));
  key.add(std::string(widest_instructions()));
  for (const std::uint32_t m : stages.body.plan.meshes) key.add(stages.mesh_keys[m].all);
  return key.key();
}

/// Evaluates the exitance over the surface if cheaper than at the hits; the decision depends on the scene
/// alone, not on cached results. Returns true if the body uses a surface cache.
bool update_surface_cache(BodyStages& stages, HierarchicalState& state) {
  const std::size_t most = stages.most_cache_places;
  if (most == 0) return false;
  const PrecomputeInput& input = stages.input;
  const Body& body = stages.body;
  const SurfaceCacheCodec codec{input.world, body.plan.meshes};
  const StageKey key = exitance_key(stages, state);
  ResultSource source = ResultSource::reused;
  if (state.surface_cache.key != key) {
    state.surface_cache = {};
    source = ResultSource::cache;
    std::optional<SurfaceCache> found = stages.store.find(key, codec);
    if (!found) {
      source = ResultSource::computed;
      found = make_body_cache(input, body, most);
      if (!found) {
        if (input.scene.settings.evaluator == EvaluatorKind::surface_cache)
          stages.note(
              fmt::format("the surface cache exceeds {} points; evaluated at shading points instead", most));
        return false;
      }
      stages.store.work().places_evaluated += found->places();
      stages.store.keep(key, *found, codec);
    }
    state.surface_cache = {key, std::move(*found)};
  }
  if (!may_use(state.surface_cache.value, input, body, most)) return false;
  stages.note("exitance of the surface", source, "evaluated");
  return true;
}

}  // namespace

void HierarchicalMethod::prepare(BodyStages& stages) const {
  auto& state = state_of<HierarchicalState>(stages.body);
  state.uses_surface_cache = false;
  const StageKey key = stages.transmitted_key();
  const bool may_have_bounces = bounces_of(stages.input.scene) > 0 && state.tree.key != StageKey{};
  ResultSource source = ResultSource::reused;
  if (key != state.direct_key || !(key == state.tree.key || may_have_bounces)) {
    state.direct_key = {};
    state.tree.key = {};
    state.irradiance = entered_irradiance(stages.body, stages.lights);
    source = update_tree(stages, key);
    state.direct_key = key;
  }
  stages.note("tree", source, "built");
  update_kernels(stages);
}

StageKey HierarchicalMethod::direct_key(const Body& body) const {
  const HierarchicalState& state = hierarchical_state(body);
  return KeyBuilder("hierarchical", 1).add(state.direct_key).add(state.kernels.key).key();
}

StageKey HierarchicalMethod::bounced_key(const Body& body) const {
  return hierarchical_state(body).tree.key;
}

void HierarchicalMethod::remove_bounced(BodyStages& stages) const {
  auto& state = state_of<HierarchicalState>(stages.body);
  state.irradiance = entered_irradiance(stages.body, stages.lights);
  update_tree(stages, state.direct_key);
  bound_far_side(state);
}

void HierarchicalMethod::add_bounced(BodyStages& stages, std::span<const RgbF> bounced,
                                     const StageKey& key) const {
  std::vector<RgbF>& irradiance = state_of<HierarchicalState>(stages.body).irradiance;
  irradiance = entered_irradiance(stages.body, stages.lights);
  for (std::size_t i = 0; i < bounced.size(); ++i) irradiance[i] += bounced[i];
  update_tree(stages, key);
}

std::unique_ptr<MethodState> HierarchicalMethod::direct_state(const BodyStages& stages) const {
  const HierarchicalState& state = hierarchical_state(stages.body);
  auto direct = std::make_unique<HierarchicalState>();
  direct->kernels.value.kernel = state.kernel();
  direct->cloud = state.cloud;
  direct->tree.value =
      gather_flux(stages.body.surface.samples, entered_irradiance(stages.body, stages.lights));
  bound_far_side(*direct);
  return direct;
}

bool HierarchicalMethod::finish(BodyStages& stages) const {
  auto& state = state_of<HierarchicalState>(stages.body);
  bound_far_side(state);
  state.cloud = body_cloud_error(stages.body, stages.input.world, stages.input.scene);
  state.uses_surface_cache = update_surface_cache(stages, state);
  return state.uses_surface_cache;
}

std::span<const RgbF> HierarchicalMethod::irradiance(const Body& body) const {
  return hierarchical_state(body).irradiance;
}

std::vector<RgbF> HierarchicalMethod::exitance_at(const Body& body, std::span<const Query> points,
                                                  const Settings& settings) const {
  const HierarchicalState& state = hierarchical_state(body);
  std::vector<RgbF> result;
  for (const Exitance& e : evaluate({state.octree(),
                                     state.kernel(),
                                     points,
                                     {},
                                     settings.evaluator,
                                     settings.tolerance,
                                     settings.laboratory.max_solid_angle,
                                     settings.laboratory.instruction_set}))
    result.push_back(e.exitance);
  return result;
}

std::unique_ptr<Field> HierarchicalMethod::field(const RenderInput& input, const Body& body) const {
  return std::make_unique<SampleField>(input, body);
}
}  // namespace opaline
