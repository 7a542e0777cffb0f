// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/session_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bodies/surface_boundaries.h"
#include "core/cancel_check.h"
#include "image/denoise.h"
#include "methods/hierarchical/surface_caches.h"
#include "plan/choose_models.h"
#include "plan/make_plan.h"
#include "plan/other_wavelengths.h"
#include "render/adaptive_rays.h"
#include "scene/same_place.h"
#include "scene/scene_properties.h"
#include "session/first_light.h"
#include "session/spectral_image.h"

namespace opaline {
namespace {

/// For each new shape, the index of an old one with its key, each old one once.
std::vector<std::optional<std::size_t>> kept_shapes(const std::vector<StageKey>& before,
                                                    const std::vector<StageKey>& now) {
  std::vector<std::optional<std::size_t>> kept(now.size());
  std::vector<bool> taken(before.size());
  for (std::size_t i = 0; i < now.size(); ++i)
    for (std::size_t j = 0; j < before.size() && !kept[i]; ++j)
      if (!taken[j] && before[j] == now[i]) {
        kept[i] = j;
        taken[j] = true;
      }
  return kept;
}

}  // namespace

void Session::State::edit(Scene scene) {
  std::vector<StageKey> sources, keys;
  for (const Shape& shape : scene.shapes) {
    sources.push_back(source_keys_.key(shape, uvs_of(scene, shape)));
    keys.push_back(shape_key(shape, sources.back()));
  }
  SessionWork work;
  std::shared_ptr<const World> world = world_;
  std::vector<MeshKeys> meshes = mesh_keys_;
  if (world == nullptr || keys != shape_keys_) {
    world = std::make_shared<const World>(loaded_world(scene, sources, keys, work));
    meshes = mesh_keys(*world);
  }
  if (scene.lights.empty())
    scene.settings.method = Method::lambert;  // a black image, with nothing to precompute
  std::vector<Light> emitters;
  for (const Light& light : scene.lights)
    if (is_of_shape(light)) emitters.push_back(light_in_world(scene, *world, light));
  choose_models(scene, *world, reference_);
  Plan plan = make_plan(scene, *world, reference_);
  scene_ = std::move(scene);
  if (world != world_) bounced_.reset();
  world_ = std::move(world);
  shape_keys_ = std::move(keys);
  mesh_keys_ = std::move(meshes);
  plan_ = std::move(plan);
  emitters_ = std::move(emitters);
  work_ = work;
  decisions_.clear();
  costs_.clear();
  prepared_ = false;
  keep_cells();
  keep_spacing();
}

/// One cache per shape: of the same source, or of a shape of the same name.
void Session::State::arrange_memories(const Scene& scene, const std::vector<StageKey>& sources) {
  std::vector<ShapeMemory> before = std::exchange(shape_memories_, {});
  shape_memories_.resize(scene.shapes.size());
  std::vector<bool> found(scene.shapes.size());
  const auto take = [&](const auto& is_wanted) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const auto it = found[i] ? before.end() : std::ranges::find_if(before, [&](const ShapeMemory& memory) {
        return is_wanted(memory, i);
      });
      if (it == before.end()) continue;
      shape_memories_[i] = std::move(*it);
      before.erase(it);
      found[i] = true;
    }
  };
  take([&](const ShapeMemory& memory, std::size_t i) { return memory.source == sources[i]; });
  take([&](const ShapeMemory& memory, std::size_t i) { return memory.name == scene.shapes[i].name; });
}

World Session::State::loaded_world(const Scene& scene, const std::vector<StageKey>& sources,
                                   const std::vector<StageKey>& shapes, SessionWork& work) {
  const auto kept = kept_shapes(shape_keys_, shapes);
  const World none;
  const World& before = world_ != nullptr ? *world_ : none;
  shape_memories_.resize(edits_ ? shape_memories_.size() : 0);
  if (!edits_) {
    World world = update_world(scene, before, kept, work.meshes_loaded);
    work.meshes_read = work.meshes_checked = work.meshes_loaded;
    return world;
  }
  arrange_memories(scene, sources);
  std::vector<MeshMemory*> memories;
  for (std::size_t i = 0; i < shape_memories_.size(); ++i) {
    ShapeMemory& memory = shape_memories_[i];
    if (memory.source != sources[i]) memory.mesh.source_changed();
    memory.source = {};  // until loaded
    memories.push_back(&memory.mesh);
  }
  const auto done = [&] {
    MeshMemory::Work sum;
    for (const MeshMemory* memory : memories) {
      sum.read += memory->work().read;
      sum.checked += memory->work().checked;
    }
    return sum;
  };
  const MeshMemory::Work first = done();
  World world = update_world(scene, before, kept, work.meshes_loaded, memories);
  work.meshes_read = done().read - first.read;
  work.meshes_checked = done().checked - first.checked;
  for (std::size_t i = 0; i < shape_memories_.size(); ++i) {
    shape_memories_[i].source = sources[i];
    shape_memories_[i].name = scene.shapes[i].name;
  }
  return world;
}

void Session::State::anchor(Scene scene, Monitor* monitor) {
  const CancelScope scope(monitor);
  edit(std::move(scene));
  reference_ = plan_.groups;
  const auto has_placed = [](const BodyPlan& group) {
    return method_of(group.method).needs_samples() && !(group.cell > 0);
  };
  if (!is_needed() || std::ranges::none_of(plan_.groups, has_placed)) return;
  arrange_bodies();
  update_rays();
  for (std::size_t g = 0; g < bodies_.size(); ++g)
    if (has_placed(bodies_[g].plan))
      update_samples(bodies_[g], keys_[g], {scene_, *world_, *rays_, plan_, monitor}, g);
  anchored_ = true;
}

// Keeps the size of cells while it is suitable: those of the reference frame, or of the last scene. An edit of a
// medium then leaves the cut surface and its shadow rays.
void Session::State::keep_cells() {
  constexpr double kSmallest = 1.3, kLargest = 1.1;  // requested size over the current one, and the inverse
  const double setting = std::exchange(cell_size_, scene_.settings.cell_size);
  if (matches_new_ || setting != cell_size_) return;
  for (BodyPlan& group : plan_.groups) {
    if (!(group.cell > 0)) continue;
    const BodyPlan* kept = nullptr;
    for (const BodyPlan& other : reference_)
      if (other.name == group.name) kept = &other;
    for (const Body& body : bodies_)
      if (reference_.empty() && body.plan.name == group.name) kept = &body.plan;
    if (kept == nullptr || kept->cell == group.cell || kept->cell_parts != group.cell_parts ||
        group.cell > kSmallest * kept->cell || kept->cell > kLargest * group.cell)
      continue;
    const double finer = group.cell / kept->cell;
    group.cell = kept->cell;
    group.samples = std::size_t(std::ceil(double(group.samples) * finer * finer));
    group.spacing = std::sqrt(group.area / double(group.samples));
    group.reason = "unchanged, close enough to " + group.reason;
  }
}

// Keeps samples without a set number while their spacing is suitable.
void Session::State::keep_spacing() {
  constexpr double kDensest = 2, kSparsest = 1.1;  // requested spacing over the current one, and the inverse
  const Settings& settings = scene_.settings;
  if (settings.samples || matches_new_) return;
  for (BodyPlan& group : plan_.groups) {
    if (group.cell > 0) continue;
    const auto body = std::ranges::find_if(bodies_, [&](const Body& b) { return b.plan.name == group.name; });
    if (body == bodies_.end()) continue;
    const SampleOrigin& origin = keys_[std::size_t(body - bodies_.begin())].origin;
    if (origin.count == 0 || origin.count == group.samples || origin.count_was_set ||
        origin.spacing_setting != settings.sample_spacing || has_outgrown(origin, group, settings))
      continue;
    const double asked = group.area / double(group.samples), there = origin.area / double(origin.count);
    if (asked > kDensest * kDensest * there || there > kSparsest * kSparsest * asked) continue;
    group.samples = origin.count;
    group.spacing = std::sqrt(group.area / double(group.samples));
    group.reason = "unchanged, close enough to " + group.reason;
  }
}

void Session::State::prepare_rays() {
  if (!costs_.empty()) return;
  const Stopwatch watch;
  update_rays();
  costs_.push_back(watch.cost("rays"));
}

Image Session::State::first_light(Monitor* monitor) {
  const CancelScope scope(monitor);
  prepare_rays();
  Image image = opaline::first_light({scene_, *world_, *rays_, plan_, monitor});
  if (scene_.wavelengths) convert_to_rgb(image, scene_.wavelengths->alone);
  return image;
}

std::vector<BodyStages> Session::State::body_stages(const PrecomputeInput& input,
                                                    std::span<const Light> lights) {
  std::vector<BodyStages> all;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    all.push_back({input, lights, mesh_keys_, bodies_[b], keys_[b], store_, walk_store_, edits_, 0});
  return all;
}

void Session::State::prepare(Monitor* monitor) {
  const CancelScope scope(monitor);
  if (prepared_) return;
  prepare_rays();
  prepared_ = !is_needed();
  if (prepared_) return;
  arrange_bodies();
  const PrecomputeInput input{scene_, *world_, *rays_, plan_, monitor};
  const std::vector<Light> lights = recentred_lights(scene_, *world_);
  const auto in_stage = [&](const char* stage, const auto& work) {
    const Stopwatch watch;
    if (work()) costs_.push_back(watch.cost(stage));
  };
  const bool needs_samples = method_of(scene_.settings.method).needs_samples();
  in_stage("sampling", [&] {
    for (std::size_t b = 0; needs_samples && b < bodies_.size(); ++b)
      update_samples(bodies_[b], keys_[b], input, b);
    return needs_samples;
  });
  in_stage("irradiance", [&] {
    bool is_needed = false;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (!method_of(bodies_[b].plan.method).needs_transmitted_light()) continue;
      update_lights(bodies_[b], keys_[b], input, b, lights);
      update_tint(bodies_[b], keys_[b]);
      is_needed = true;
    }
    return is_needed;
  });
  std::vector<BodyStages> bodies = body_stages(input, lights);
  // From the last method to the first: volume_diffusion leaves some bodies to hierarchical.
  for (std::size_t m = kMethodNames.size(); m-- > 0;) {
    const auto is_of = [&](const BodyStages& stages) { return stages.body.plan.method == Method(m); };
    if (std::ranges::none_of(bodies, is_of)) continue;
    const SubsurfaceMethod& method = method_of(Method(m));
    in_stage(method.stage(), [&] {
      for (BodyStages& stages : bodies)
        if (is_of(stages)) method.prepare(stages);
      return true;
    });
  }
  if (needs_samples &&
      std::ranges::any_of(plan_.groups, [&](const BodyPlan& body) { return gathers_light(scene_, body); }))
    in_stage("bounces", [&] {
      update_bounces(bodies);
      return true;
    });
  in_stage("exitance", [&] {
    const std::vector<std::size_t> most = most_cache_places(input, bodies_, pictures_);
    bool has_caches = false;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      bodies[b].most_cache_places = most[b];
      has_caches |= method_of(bodies_[b].plan.method).finish(bodies[b]);
    }
    return has_caches;
  });
  prepared_ = true;
}

RenderResult Session::render(Monitor* monitor) {
  const CancelScope scope(monitor);
  RenderResult result =
      state_->scene_.wavelengths ? state_->spectral_image(monitor) : state_->channels_image(monitor);
  if (state_->scene_.film.denoise) denoise(result.image, result.translucent, monitor);
  return result;
}

RenderResult Session::State::channels_image(Monitor* monitor) {
  prepare(monitor);
  if (auto image = method_of(scene_.settings.method).render_image({scene_, *world_, *rays_, plan_, monitor}))
    return *std::move(image);
  HeldView* const view = held_view();
  if (view != nullptr) view->next_picture();
  RenderInput input{scene_, *world_, *rays_, bodies(), monitor, view};
  if (bounces_of(scene_) > 0) update_bounced_places(input);
  input.bounced = bounced_;
  if (repeats_rays_) input.adaptive_rays = adaptive_rays_;
  RenderResult result = has_adaptive_rays(scene_) ? render_adaptive(input) : opaline::render(input);
  adaptive_rays_ = result.adaptive.rays;
  work_.queries += result.queries;
  return result;
}

/// Renders each group of wavelengths as an edit of the media and colours, by the adaptive rays of the first. The first
/// group's scene remains.
RenderResult Session::State::spectral_image(Monitor* monitor) {
  const Scene first = scene_;
  const std::vector<BodyPlan> reference = reference_;
  std::vector<StageCost> costs;
  const bool repeats = repeats_rays_;
  const auto restore = [&] {
    repeats_rays_ = repeats;
    if (first.other_wavelengths.empty()) return;
    edit(first);
    reference_ = reference;
    costs_ = costs;
  };
  RenderResult sum;
  WavelengthLayers layers;
  try {
    sum = channels_image(monitor);
    costs = costs_;
    if (keeps_wavelengths_) layers.keep(sum.image, *scene_.wavelengths);
    convert_to_rgb(sum.image, scene_.wavelengths->to_rgb);
    if (reference_.empty()) reference_ = plan_.groups;  // same profiles at all wavelengths
    repeats_rays_ = true;
    for (std::size_t g = 0; g < first.other_wavelengths.size(); ++g) {
      edit(at_other_wavelengths(first, g));
      RenderResult result = channels_image(monitor);
      if (keeps_wavelengths_) layers.keep(result.image, *scene_.wavelengths);
      convert_to_rgb(result.image, scene_.wavelengths->to_rgb);
      add_colors(sum.image, result.image);
      sum.queries += result.queries;
      sum.non_finite += result.non_finite;
      sum.adaptive.noise = std::max(sum.adaptive.noise, result.adaptive.noise);
      sum.adaptive.settings_error = std::max(sum.adaptive.settings_error, result.adaptive.settings_error);
      costs.insert(costs.end(), costs_.begin(), costs_.end());
    }
  } catch (...) {
    restore();
    throw;
  }
  restore();
  layers.append(sum.image);
  return sum;
}

/// Valid cache of earlier images; null: caching is off.
HeldView* Session::State::held_view() {
  if (!holds_view_ || !scene_.shutter.empty()) {
    view_ = {};
    return nullptr;
  }
  const PrecomputeInput input{scene_, *world_, *rays_, plan_};
  const std::vector<Light> lights = recentred_lights(scene_, *world_);
  const StageKey key = view_key(input, mesh_keys_), surfaces_key = view_surfaces_key(input, lights);
  std::vector<StageKey> light_keys;
  for (const Light& light : lights) light_keys.push_back(view_light_key(light));
  const bool sees_the_same = key == view_key_ && surfaces_key == view_surfaces_key_;
  if (key != view_key_) view_.forget_camera();
  if (!sees_the_same) view_.forget_surfaces();
  const StageKey near_key = view_near_key(input, mesh_keys_, surfaces_key);
  if (near_key != view_near_key_) view_.lattices.clear();
  view_near_key_ = near_key;
  const StageKey coats_key = view_coats_key(scene_);
  if (coats_key != view_coats_key_) view_.forget_coats();
  view_coats_key_ = coats_key;
  if (light_keys != view_light_keys_) {
    std::vector<std::optional<std::size_t>> before;
    for (const StageKey& light : light_keys) {
      const auto old = std::ranges::find(view_light_keys_, light);
      before.emplace_back();
      if (old != view_light_keys_.end()) before.back() = std::size_t(old - view_light_keys_.begin());
    }
    view_.set_lights(before);
  }
  view_key_ = key;
  view_surfaces_key_ = surfaces_key;
  view_light_keys_ = std::move(light_keys);
  view_.count_gathered();
  return &view_;
}

void Session::State::update_rays() {
  const auto same = [](const MeshKeys& a, const MeshKeys& b) { return a.all == b.all; };
  if (rays_ == nullptr || rays_build_ != plan_.rays || !std::ranges::equal(rays_keys_, mesh_keys_, same)) {
    rays_ = nullptr;  // never both in memory
    rays_build_ = plan_.rays;
    rays_ = std::make_unique<RayScene>(*world_, rays_build_);
    ++work_.ray_builds;
    rays_keys_ = mesh_keys_;
    moved_by_.clear();
  }
  if (moved_by_ == scene_.shutter) return;
  moved_by_.clear();
  rays_->set_motion(*world_, mesh_motions());
  moved_by_ = scene_.shutter;
}

/// Steps between the poses that the rays need of a shape: half of all if it moves straight in each half, otherwise 1.
std::size_t Session::State::pose_stride(std::size_t shape) const {
  const std::size_t half = scene_.shutter.size() / 2;
  const auto place = [&](std::size_t pose) { return scene_.shutter[pose].shapes[shape].to_world; };
  return half > 1 && is_between(place(half / 2), place(0), place(half)) &&
                 is_between(place(half + half / 2), place(half), place(2 * half))
             ? half
             : 1;
}

/// Motions while the shutter is open; empty: no shape moves.
std::vector<MeshMotion> Session::State::mesh_motions() const {
  std::vector<MeshMotion> motions(scene_.shapes.size());
  for (std::size_t i = 0; i < motions.size() && !scene_.shutter.empty(); ++i) {
    const std::size_t middle = scene_.shutter.size() / 2, stride = pose_stride(i);
    const auto stays = [&](const ShutterPose& pose) {
      return in_same_place(pose.shapes[i], scene_.shapes[i]);
    };
    if (std::ranges::all_of(scene_.shutter, stays)) continue;
    for (std::size_t k = 0; k < scene_.shutter.size(); k += stride) {
      motions[i].emplace_back();
      if (k == middle) continue;
      motions[i].back() = moved_vertices(scene_, *world_, i, scene_.shutter[k].shapes[i]);
      if (motions[i].back().empty()) break;
    }
    if (motions[i].back().empty()) motions[i].clear();  // the triangles differ
  }
  if (std::ranges::all_of(motions, &MeshMotion::empty)) return {};
  return motions;
}

/// Creates a body for each one of the plan, with the cached results of the one with the same name.
void Session::State::arrange_bodies() {
  std::vector<Body> bodies(plan_.groups.size());
  std::vector<BodyKeys> keys(plan_.groups.size());
  const std::vector<OuterBoundary> boundaries = boundaries_of(scene_, *world_);
  for (std::size_t g = 0; g < bodies.size(); ++g) {
    const BodyPlan& plan = plan_.groups[g];
    const auto old = std::ranges::find_if(
        bodies_, [&](const Body& b) { return b.plan.name == plan.name && b.plan.shared == plan.shared; });
    if (old != bodies_.end()) {
      keys[g] = std::move(keys_[std::size_t(old - bodies_.begin())]);
      bodies[g] = std::move(*old);
      old->plan.name.clear();
    }
    bodies[g].plan = plan;
    bodies[g].profile = make_diffuse_profile(scene_.media[plan.medium], world_->unit);
    bodies[g].boundary = boundaries[plan.meshes.front()];
  }
  bodies_ = std::move(bodies);
  keys_ = std::move(keys);
}

}  // namespace opaline
