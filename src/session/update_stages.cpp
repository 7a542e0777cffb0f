// SPDX-License-Identifier: GPL-3.0-or-later
// Each stage's result: kept, from the cache, or computed; under its key only once it is whole.
#include <fmt/format.h>

#include "opaline/exitance/cloud_error.h"
#include "opaline/lights/light.h"
#include "opaline/render/surface_caches.h"
#include "opaline/render/surface_textures.h"
#include "opaline/sampling/carry_samples.h"
#include "session/session_state.h"

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

void Session::State::update_samples(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                    std::size_t group) {
  if (body.plan.cell > 0) return cut_anew(body, known, input);
  const StageKey anew = samples_key(input, mesh_keys_, group);
  if (anew == known.samples_key) return keep_samples(body, known);
  if (anew == known.origin.key) {  // back where they were placed
    body.surface = std::move(known.origin.surface);
    known.meshes = known.origin.meshes;
    known.samples_key = anew;
    return keep_samples(body, known);
  }
  if (matches_new_ || !is_from_this_plan(known.origin, input, group) ||
      has_outgrown(known.origin, body.plan, input.scene.settings) ||
      !can_carry(*known.origin.world, known.origin.meshes, *world_, body.plan.meshes))
    return place_anew(body, known, input, group, anew);
  const StageKey carried =
      carried_samples_key(known.origin.key, body.plan, mesh_keys_, known.origin.world->unit / world_->unit);
  if (carried == known.samples_key) return keep_samples(body, known);
  carry_along(body, known, input, carried);
}

void Session::State::keep_samples(Body& body, BodyKeys& known) {
  renumber(body.surface.samples, known.meshes, body.plan.meshes);
  known.meshes = body.plan.meshes;
  if (!known.is_carried()) {
    known.origin.world = world_;
    known.origin.meshes = known.meshes;
  }
  note_decision(body, fmt::format("{} samples kept", body.surface.samples.size()));
}

// Next to nothing beside what follows, so that they are not kept in a cache.
void Session::State::cut_anew(Body& body, BodyKeys& known, const PrecomputeInput& input) {
  const StageKey key = cut_surface_key(body.plan, mesh_keys_, world_->unit);
  if (key == known.samples_key) return keep_samples(body, known);
  if (anchored_ && !known.is_carried()) known.origin.surface = std::move(body.surface);
  if (!anchored_) known.origin = {};
  known.samples_key = {};
  CutSurface cut = cut_surface(input, body);
  body.surface = std::move(cut.surface);
  known.cut_normals = std::move(cut.normals);
  known.meshes = body.plan.meshes;
  known.samples_key = key;
  work_.samples_placed += body.surface.samples.size();
  note_decision(body, fmt::format("{} samples placed anew", body.surface.samples.size()));
}

void Session::State::place_anew(Body& body, BodyKeys& known, const PrecomputeInput& input, std::size_t group,
                                const StageKey& key) {
  const Settings& settings = input.scene.settings;
  if (anchored_ && !known.is_carried()) known.origin.surface = std::move(body.surface);
  known.samples_key = {};
  if (!anchored_) known.origin = {};
  std::optional<SurfaceSamples> found;
  SurfaceCells cells;
  if (cache_ != nullptr) found = cache_->find_samples(key, {*world_, body.plan.meshes, body.plan.samples});
  work_.found += found ? 1 : 0;
  if (found) {
    body.surface = std::move(*found);
  } else {
    body.surface = place_samples(input, group, edits_ && !anchored_ ? &cells : nullptr);
    work_.samples_placed += body.surface.samples.size();
    work_.samples_divided += body.surface.samples.size();
    if (cache_ != nullptr) cache_->keep_samples(key, body.surface, body.plan.meshes);
  }
  known.meshes = body.plan.meshes;
  if (!anchored_)
    known.origin = {world_,
                    known.meshes,
                    key,
                    sampling_seed(settings, group),
                    body.plan.samples,
                    body.surface.area * world_->unit * world_->unit,
                    {},
                    std::move(cells),
                    settings.samples.has_value(),
                    settings.sample_spacing};
  known.samples_key = key;
  note_decision(body, fmt::format("{} samples {}", body.surface.samples.size(),
                                  found ? "from the cache" : "placed anew"));
}

void Session::State::carry_along(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                 const StageKey& key) {
  if (!known.is_carried()) known.origin.surface = std::move(body.surface);
  known.samples_key = {};
  std::optional<SurfaceSamples> found;
  if (cache_ != nullptr)
    found = cache_->find_samples(key, {*world_, body.plan.meshes, carried_count(known.origin, body.plan)});
  if (found) {
    body.surface = std::move(*found);
    ++work_.found;
    note_decision(body, fmt::format("{} samples from the cache", body.surface.samples.size()));
  } else {
    CarriedSamples carried =
        carry_samples({*known.origin.world, known.origin.meshes, *world_, body.plan.meshes,
                       known.origin.surface, known.origin.cells, input.monitor});
    body.surface = std::move(carried.surface);
    work_.samples_carried += body.surface.samples.size() - carried.added;
    work_.samples_placed += carried.added;
    work_.samples_removed += carried.removed;
    work_.samples_divided += carried.divided ? body.surface.samples.size() : 0;
    if (cache_ != nullptr) cache_->keep_samples(key, body.surface, body.plan.meshes);
    note_decision(body, carried.rigid
                            ? fmt::format("{} samples went along", body.surface.samples.size())
                            : fmt::format("{} samples went along, {} added, {} removed",
                                          body.surface.samples.size(), carried.added, carried.removed));
  }
  known.meshes = body.plan.meshes;
  known.samples_key = key;
}

void Session::State::update_lights(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                   std::size_t group, const std::vector<Light>& lights) {
  std::vector<StageKey> keys;
  std::vector<LightTransfer> transfers(lights.size());
  std::vector<Light> missing;
  std::vector<std::size_t> places;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    keys.push_back(transfer_key(input, known.samples_key, mesh_keys_, group, lights[l]));
    const auto old = std::ranges::find(known.light_keys, keys[l]);
    std::optional<LightTransfer> found;
    if (old != known.light_keys.end()) {
      transfers[l] = body.transfers[std::size_t(old - known.light_keys.begin())];
      note_decision(body, fmt::format("light of {} kept", lights[l].name));
    } else if (cache_ != nullptr && (found = cache_->find_light(keys[l], body.surface.samples.size()))) {
      transfers[l] = std::move(*found);
      ++work_.found;
      note_decision(body, fmt::format("light of {} from the cache", lights[l].name));
    } else {
      missing.push_back(lights[l]);
      places.push_back(l);
      note_decision(body, fmt::format("light of {} traced", lights[l].name));
    }
  }
  if (!missing.empty()) {
    const std::uint64_t before = rays_->statistics().rays;
    std::vector<LightTransfer> traced = light_samples(input, group, body.surface.samples, missing);
    work_.sample_rays += rays_->statistics().rays - before;
    work_.lights_traced += missing.size();
    for (std::size_t i = 0; i < missing.size(); ++i) {
      if (cache_ != nullptr) cache_->keep_light(keys[places[i]], traced[i]);
      transfers[places[i]] = std::move(traced[i]);
    }
  }
  known.light_keys = std::move(keys);
  body.transfers = std::move(transfers);
}

void Session::State::update_tint(Body& body, BodyKeys& known) {
  const StageKey key = tint_key(scene_, *world_, body.plan.meshes, known.samples_key);
  if (key == known.tint_key) return;
  known.tint_key = {};
  body.entering.clear();
  if (key != StageKey{})
    body.entering = entering_tints(SurfaceTextures(scene_, *world_), body.surface.samples);
  known.tint_key = key;
}

void Session::State::update_tree(Body& body, BodyKeys& known, const std::vector<Light>& lights) {
  update_tint(body, known);
  const StageKey key = octree_key(known.samples_key, known.light_keys, lights, known.tint_key);
  const bool may_hold_bounces = bounces_of(scene_) > 0 && known.tree_key != StageKey{};
  if (key == known.lights_key && (key == known.tree_key || may_hold_bounces))
    return note_decision(body, "tree kept");
  known.lights_key = {};
  body.irradiance = entered_irradiance(body, lights);
  known.tree_key = {};
  const std::uint64_t before = work_.nodes_built;
  hold_tree(body, known, key);
  known.lights_key = key;
  note_decision(body, work_.nodes_built == before ? "tree from the cache" : "tree built");
}

/// The tree of the body's irradiance, which has that key.
void Session::State::hold_tree(Body& body, BodyKeys& known, const StageKey& key) {
  if (known.tree_key == key) return;
  known.tree_key = {};
  std::optional<Octree> found;
  if (cache_ != nullptr) found = cache_->find_octree(key, body.surface);
  if (found) {
    body.octree = std::move(*found);
    ++work_.found;
  } else {
    body.octree = gather_flux(body.surface.samples, body.irradiance);
    work_.nodes_built += body.octree.nodes.size();
    if (cache_ != nullptr) cache_->keep_octree(key, body.octree);
  }
  known.tree_key = key;
}

/// The shapes of tabulated profiles: those in the cache need not be walked, and what is walked is kept there.
void Session::State::find_walked_profiles(const Body& body) {
  if (cache_ == nullptr) return;
  for (const ChannelProfile& channel : body.profile.channels) {
    const auto* profile = std::get_if<TabulatedProfile>(&channel);
    if (profile == nullptr || profile->mean_free_path == 0) continue;
    const double absorbed = profile->absorbed, eta = profile->eta;
    if (has_walked_table(absorbed, eta)) continue;
    const StageKey key = walked_profile_key(absorbed, eta);
    if (std::optional<RadialTable> found = cache_->find_walked_profile(key)) {
      take_walked_table(absorbed, eta, std::move(*found));
      ++work_.found;
    } else {
      cache_->keep_walked_profile(key, profile->shape->get().table);
    }
  }
}

void Session::State::update_kernel(Body& body, BodyKeys& known) {
  const Medium& medium = scene_.media[body.plan.medium];
  KeyBuilder key("kernel", 4);
  std::visit([&](const auto& coefficients) { key.add(coefficients); }, medium.coefficients);
  key.add(std::uint64_t(medium.coefficients.index())).add(medium.eta).add(profile_kind(medium));
  if (profile_kind(medium) == ProfileKind::multipole) key.add(profile_thickness(medium));
  if (profile_kind(medium) == ProfileKind::normalized_diffusion) key.add(profile_fit(medium));
  key.add(body.surface.spacing()).add(world_->diagonal).add(world_->unit);
  key.add(scene_.settings.laboratory.near_field).add(near_irradiance(scene_));
  if (key.key() == known.kernel_key) return;
  known.kernel_key = {};
  find_walked_profiles(body);
  body.kernel = group_kernel(body.profile, body.surface.spacing(), *world_, scene_);
  body.wider_kernel = group_kernel(body.profile, kWiderField * body.surface.spacing(), *world_, scene_);
  known.kernel_key = key.key();
}

// Whether a cache is used depends on the scene alone, not on what is at hand.
void Session::State::update_exitance(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                     std::size_t most_places) {
  if (most_places == 0) return;
  const StageKey key = exitance_key(known.tree_key, known.kernel_key, mesh_keys_, body.plan, scene_.settings);
  if (key != known.exitance_key) known.spare_cache.reset();
  const bool at_hand = known.spare_cache.has_value();
  std::optional<SurfaceCache> found;
  if (!at_hand && cache_ != nullptr) found = cache_->find_exitance(key, *world_, body.plan.meshes);
  work_.found += found ? 1 : 0;
  if (found) known.spare_cache = std::move(found);
  if (!known.spare_cache) {
    known.spare_cache = make_group_cache(input, body, most_places);
    if (!known.spare_cache) {
      if (scene_.settings.evaluator == EvaluatorKind::surface_cache)
        note_decision(body,
                      fmt::format("more than {} places of the surface: evaluated at the picture's points",
                                  most_places));
      return;
    }
    work_.places_evaluated += known.spare_cache->places();
    if (cache_ != nullptr) cache_->keep_exitance(key, *known.spare_cache, body.plan.meshes);
  }
  known.exitance_key = key;
  if (!may_use(*known.spare_cache, input, body, most_places)) return;
  body.surface_cache = std::move(known.spare_cache);
  known.spare_cache.reset();
  note_decision(body,
                at_hand ? "exitance of the surface kept"
                        : fmt::format("exitance of the surface {}", found ? "from the cache" : "evaluated"));
}

}  // namespace opaline
