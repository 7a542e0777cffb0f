// SPDX-License-Identifier: GPL-3.0-or-later
// Each stage's result: kept, from the cache, or computed; under its key only once it is whole.
#include <fmt/format.h>

#include "opaline/render/surface_caches.h"
#include "opaline/sampling/carry_samples.h"
#include "session/session_part.h"

namespace opaline {
namespace {

bool is_from_this_plan(const SampleOrigin& origin, const PrecomputeInput& input, std::size_t group) {
  return origin.key != StageKey{} && origin.count == input.plan.groups[group].samples &&
         origin.seed == sampling_seed(input.scene.settings, group);
}

void renumber(std::vector<SurfaceSample>& samples, const std::vector<std::uint32_t>& from,
              const std::vector<std::uint32_t>& to) {
  if (from == to) return;
  for (SurfaceSample& s : samples) s.mesh = to[std::size_t(std::ranges::find(from, s.mesh) - from.begin())];
}

/// As many as the stretched surface takes at the spacing that its samples have.
std::size_t carried_count(const SampleOrigin& origin, const GroupPlan& plan) {
  const double stretched = origin.area > 0 ? std::max(1.0, plan.area / origin.area) : 1;
  return std::size_t(std::min(1e9, double(origin.surface.samples.size()) * stretched));
}

}  // namespace

bool has_outgrown(const SampleOrigin& origin, const GroupPlan& plan, const Settings& settings) {
  constexpr double kMore = 2;          // times the number, where the scene allows no more than that
  constexpr double kFewer = 1.0 / 16;  // of the number: four times as far apart as asked for
  if (!(origin.area > 0)) return false;
  const double count = double(origin.count), carried = count * (plan.area / origin.area);
  const bool by_number = origin.count_was_set || origin.count >= settings.max_samples;
  return carried > std::max(double(settings.max_samples), kMore * count) ||
         (by_number && carried < kFewer * count);
}

void Session::bring_samples(Part& part, const PrecomputeInput& input, std::size_t group) {
  const StageKey anew = samples_key(input, mesh_keys_, group);
  if (anew == part.samples_key) return keep_samples(part);
  if (anew == part.origin.key) {  // back where they were placed
    part.surface = std::move(part.origin.surface);
    part.meshes = part.origin.meshes;
    part.samples_key = anew;
    return keep_samples(part);
  }
  if (!is_from_this_plan(part.origin, input, group) ||
      has_outgrown(part.origin, part.plan, input.scene.settings) ||
      !can_carry(*part.origin.world, part.origin.meshes, *world_, part.plan.meshes))
    return place_anew(part, input, group, anew);
  const StageKey carried =
      carried_samples_key(part.origin.key, part.plan, mesh_keys_, part.origin.world->unit / world_->unit);
  if (carried == part.samples_key) return keep_samples(part);
  carry_along(part, input, carried);
}

void Session::keep_samples(Part& part) {
  renumber(part.surface.samples, part.meshes, part.plan.meshes);
  part.meshes = part.plan.meshes;
  if (!part.is_carried()) {
    part.origin.world = world_;
    part.origin.meshes = part.meshes;
  }
  decide(part, fmt::format("{} samples kept", part.surface.samples.size()));
}

void Session::place_anew(Part& part, const PrecomputeInput& input, std::size_t group, const StageKey& key) {
  const Settings& settings = input.scene.settings;
  if (anchored_ && !part.is_carried()) part.origin.surface = std::move(part.surface);
  part.samples_key = {};
  if (!anchored_) part.origin = {};
  std::optional<SurfaceSamples> found;
  SurfaceCells cells;
  if (cache_ != nullptr) found = cache_->find_samples(key, {*world_, part.plan.meshes, part.plan.samples});
  work_.found += found ? 1 : 0;
  if (found) {
    part.surface = std::move(*found);
  } else {
    part.surface = place_samples(input, group, edits_ && !anchored_ ? &cells : nullptr);
    work_.samples_placed += part.surface.samples.size();
    work_.samples_divided += part.surface.samples.size();
    if (cache_ != nullptr) cache_->keep_samples(key, part.surface, part.plan.meshes);
  }
  part.meshes = part.plan.meshes;
  if (!anchored_)
    part.origin = {world_,
                   part.meshes,
                   key,
                   sampling_seed(settings, group),
                   part.plan.samples,
                   part.surface.area * world_->unit * world_->unit,
                   {},
                   std::move(cells),
                   settings.samples.has_value(),
                   settings.sample_spacing};
  part.samples_key = key;
  decide(part,
         fmt::format("{} samples {}", part.surface.samples.size(), found ? "from the cache" : "placed anew"));
}

void Session::carry_along(Part& part, const PrecomputeInput& input, const StageKey& key) {
  if (!part.is_carried()) part.origin.surface = std::move(part.surface);
  part.samples_key = {};
  std::optional<SurfaceSamples> found;
  if (cache_ != nullptr)
    found = cache_->find_samples(key, {*world_, part.plan.meshes, carried_count(part.origin, part.plan)});
  if (found) {
    part.surface = std::move(*found);
    ++work_.found;
    decide(part, fmt::format("{} samples from the cache", part.surface.samples.size()));
  } else {
    CarriedSamples carried = carry_samples({*part.origin.world, part.origin.meshes, *world_, part.plan.meshes,
                                            part.origin.surface, part.origin.cells, input.monitor});
    part.surface = std::move(carried.surface);
    work_.samples_carried += part.surface.samples.size() - carried.added;
    work_.samples_placed += carried.added;
    work_.samples_removed += carried.removed;
    work_.samples_divided += carried.divided ? part.surface.samples.size() : 0;
    if (cache_ != nullptr) cache_->keep_samples(key, part.surface, part.plan.meshes);
    decide(part, carried.rigid ? fmt::format("{} samples went along", part.surface.samples.size())
                               : fmt::format("{} samples went along, {} added, {} removed",
                                             part.surface.samples.size(), carried.added, carried.removed));
  }
  part.meshes = part.plan.meshes;
  part.samples_key = key;
}

void Session::bring_lights(Part& part, const PrecomputeInput& input, std::size_t group,
                           const std::vector<Light>& lights) {
  std::vector<StageKey> keys;
  std::vector<LightTransfer> transfers(lights.size());
  std::vector<Light> missing;
  std::vector<std::size_t> places;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    keys.push_back(transfer_key(input, part.samples_key, mesh_keys_, group, lights[l]));
    const auto old = std::ranges::find(part.light_keys, keys[l]);
    std::optional<LightTransfer> found;
    if (old != part.light_keys.end()) {
      transfers[l] = part.transfers[std::size_t(old - part.light_keys.begin())];
      decide(part, fmt::format("light of {} kept", lights[l].name));
    } else if (cache_ != nullptr && (found = cache_->find_light(keys[l], part.surface.samples.size()))) {
      transfers[l] = std::move(*found);
      ++work_.found;
      decide(part, fmt::format("light of {} from the cache", lights[l].name));
    } else {
      missing.push_back(lights[l]);
      places.push_back(l);
      decide(part, fmt::format("light of {} traced", lights[l].name));
    }
  }
  if (!missing.empty()) {
    const std::uint64_t before = rays_->statistics().rays;
    std::vector<LightTransfer> traced = light_samples(input, group, part.surface.samples, missing);
    work_.sample_rays += rays_->statistics().rays - before;
    work_.lights_traced += missing.size();
    for (std::size_t i = 0; i < missing.size(); ++i) {
      if (cache_ != nullptr) cache_->keep_light(keys[places[i]], traced[i]);
      transfers[places[i]] = std::move(traced[i]);
    }
  }
  part.light_keys = std::move(keys);
  part.transfers = std::move(transfers);
}

void Session::bring_tree(Part& part, const std::vector<Light>& lights) {
  const StageKey key = octree_key(part.samples_key, part.light_keys, lights);
  if (key == part.tree_key) return decide(part, "tree kept");
  part.tree_key = {};
  part.irradiance = combine_lights(part.transfers, lights);
  std::optional<Octree> found;
  if (cache_ != nullptr) found = cache_->find_octree(key, part.surface);
  if (found) {
    part.octree = std::move(*found);
    ++work_.found;
  } else {
    part.octree = gather_flux(part.surface.samples, part.irradiance);
    work_.nodes_built += part.octree.nodes.size();
    if (cache_ != nullptr) cache_->keep_octree(key, part.octree);
  }
  part.tree_key = key;
  decide(part, found ? "tree from the cache" : "tree built");
}

void Session::bring_kernel(Part& part) {
  const Medium& medium = scene_.media[part.plan.medium];
  KeyBuilder key("kernel", 2);
  std::visit([&](const auto& coefficients) { key.add(coefficients); }, medium.coefficients);
  key.add(std::uint64_t(medium.coefficients.index())).add(medium.eta).add(medium.profile);
  key.add(part.surface.spacing()).add(world_->diagonal).add(world_->unit);
  key.add(scene_.settings.near_field).add(scene_.settings.near_irradiance);
  if (key.key() == part.kernel_key) return;
  part.kernel_key = {};
  part.kernel.emplace(group_kernel(part.profile, part.surface, *world_, scene_.settings));
  part.kernel_key = key.key();
}

// Whether a cache is used depends on the scene alone, not on what is at hand.
void Session::bring_exitance(Part& part, TranslucentGroup& group, const PrecomputeInput& input,
                             std::size_t most_places) {
  if (most_places == 0) return;
  const StageKey key = exitance_key(part.tree_key, part.kernel_key, mesh_keys_, group.plan, scene_.settings);
  if (key != part.exitance_key) part.surface_cache.reset();
  const bool at_hand = part.surface_cache.has_value();
  std::optional<SurfaceCache> found;
  if (!at_hand && cache_ != nullptr) found = cache_->find_exitance(key, *world_, group.plan.meshes);
  work_.found += found ? 1 : 0;
  if (found) part.surface_cache = std::move(found);
  if (!part.surface_cache) {
    part.surface_cache = make_group_cache(input, group, most_places);
    if (!part.surface_cache) {
      if (scene_.settings.evaluator == EvaluatorKind::surface_cache)
        decide(part, fmt::format("more than {} places of the surface: evaluated at the picture's points",
                                 most_places));
      return;
    }
    work_.places_evaluated += part.surface_cache->places();
    if (cache_ != nullptr) cache_->keep_exitance(key, *part.surface_cache, group.plan.meshes);
  }
  part.exitance_key = key;
  if (!may_use(*part.surface_cache, input, group, most_places)) return;
  group.surface_cache = std::move(part.surface_cache);
  part.surface_cache.reset();
  decide(part, at_hand ? "exitance of the surface kept"
                       : fmt::format("exitance of the surface {}", found ? "from the cache" : "evaluated"));
}

}  // namespace opaline
