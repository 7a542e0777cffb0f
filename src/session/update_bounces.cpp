// SPDX-License-Identifier: GPL-3.0-or-later
// The light that goes from one surface to another: at the samples of bodies and at places of the picture.
#include <algorithm>

#include "opaline/lights/light.h"
#include "session/session_state.h"

namespace opaline {
namespace {

void tint_bounced(const Body& body, std::span<RgbF> bounced) {
  for (std::size_t i = 0; i < body.entering.size(); ++i) bounced[i] = bounced[i] * body.entering[i];
}

/// What other surfaces send to a body's samples, to what enters there from lights.
void add_bounced(Body& body, std::span<const RgbF> bounced) {
  for (std::size_t i = 0; i < bounced.size(); ++i) body.irradiance[i] += bounced[i];
}

/// The parts of a body that depend on its light.
struct BodyLight {
  std::vector<RgbF> irradiance;
  Octree octree;
  std::optional<SurfaceCache> surface_cache;
  std::shared_ptr<const CellFit> volume_fit;
};

/// Direct light of a body, without bounces.
/// error Error{interrupted}
BodyLight direct_light(const Body& body, const BodyKeys& keys, const std::vector<Light>& lights) {
  BodyLight direct;
  if (body.plan.method == Method::volume_diffusion) {
    direct.volume_fit = keys.lit_fit;
    return direct;
  }
  direct.volume_fit = body.volume_fit;
  direct.irradiance = entered_irradiance(body, lights);
  direct.octree = gather_flux(body.surface.samples, direct.irradiance);
  if (body.kernel.far_side != nullptr) bound_normals(direct.octree);
  return direct;
}

/// Replaces the light of bodies by their direct light, from which the first bounce is gathered; the destructor restores
/// it. An interrupted constructor leaves the bodies unchanged: it replaces nothing before it has computed everything,
/// because no destructor would restore it.
class DirectlyLitBodies {
 public:
  DirectlyLitBodies(std::vector<Body>& bodies, const std::vector<BodyKeys>& keys,
                    const std::vector<Light>& lights)
      : bodies_(bodies) {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      other_.push_back(direct_light(bodies[b], keys[b], lights));
    exchange();
  }
  ~DirectlyLitBodies() { exchange(); }
  DirectlyLitBodies(const DirectlyLitBodies&) = delete;
  DirectlyLitBodies& operator=(const DirectlyLitBodies&) = delete;

 private:
  void exchange() noexcept {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      std::swap(bodies_[b].irradiance, other_[b].irradiance);
      std::swap(bodies_[b].octree, other_[b].octree);
      std::swap(bodies_[b].surface_cache, other_[b].surface_cache);
      std::swap(bodies_[b].volume_fit, other_[b].volume_fit);
    }
  }

  std::vector<Body>& bodies_;
  std::vector<BodyLight> other_;  // one a body
};

}  // namespace

// Trees and cells with the light that bounces in place of those without it. What bounces depends on all bodies.
void Session::State::update_bounces(const PrecomputeInput& input, const std::vector<Light>& lights) {
  const auto has_cells = [&](std::size_t b) { return bodies_[b].plan.method == Method::volume_diffusion; };
  KeyBuilder all("bounces", 2);
  all.add(surfaces_key(input, mesh_keys_, lights));
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (has_cells(b))
      all.add(keys_[b].volume_key);
    else
      all.add(keys_[b].lights_key).add(keys_[b].kernel_key);
  const StageKey bounces = all.key();
  std::vector<StageKey> wanted;
  bool are_there = true;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const BodyKeys& known = keys_[b];
    KeyBuilder key(has_cells(b) ? "diffusion with bounces" : "octree with bounces", 1);
    wanted.push_back(key.add(bounces).add(has_cells(b) ? known.volume_key : known.lights_key).key());
    are_there = are_there && (has_cells(b) ? known.bounced_key : known.tree_key) == wanted[b];
  }
  if (are_there) return;
  std::vector<std::vector<RgbF>> bounced = kept_bounces(wanted);
  if (bounced.empty()) {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      if (has_cells(b)) {
        forget_bounced(bodies_[b], keys_[b]);
      } else {
        bodies_[b].irradiance = entered_irradiance(bodies_[b], lights);
        hold_tree(bodies_[b], keys_[b], keys_[b].lights_key);
        bound_far_side(bodies_[b]);
      }
    bounced = bounced_at_samples(input, bodies_, held_view_of_samples(input));
    for (std::size_t b = 0; cache_ != nullptr && b < bodies_.size(); ++b)
      cache_->keep_bounced(wanted[b], bounced[b]);
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    tint_bounced(bodies_[b], bounced[b]);
    if (has_cells(b)) {
      diffuse_bounced(bodies_[b], keys_[b], input, bounced[b], wanted[b]);
    } else {
      bodies_[b].irradiance = entered_irradiance(bodies_[b], lights);
      add_bounced(bodies_[b], bounced[b]);
      hold_tree(bodies_[b], keys_[b], wanted[b]);
    }
    note_decision(bodies_[b], "light of other surfaces gathered");
  }
}

/// What is held, with what the bodies' samples as they are now gathered; null: nothing is to be held.
HeldView* Session::State::held_view_of_samples(const PrecomputeInput& input) {
  HeldView* const view = held_view();
  if (view == nullptr) return nullptr;
  KeyBuilder builder("gathered at samples", 1);
  builder.add(scene_.settings.seed).add(input.plan.rays);
  for (const MeshKeys& mesh : mesh_keys_) builder.add(mesh.all);
  for (const BodyKeys& known : keys_) builder.add(known.samples_key);
  const StageKey key = builder.key();
  if (key != view_samples_key_) view->at_samples.clear();
  view_samples_key_ = key;
  return view;
}

/// From the cache; empty where it lacks one of them.
std::vector<std::vector<RgbF>> Session::State::kept_bounces(std::span<const StageKey> keys) {
  std::vector<std::vector<RgbF>> all;
  for (std::size_t b = 0; cache_ != nullptr && b < bodies_.size(); ++b) {
    auto found = cache_->find_bounced(keys[b], bodies_[b].surface.samples.size());
    if (!found) return {};
    all.push_back(std::move(*found));
  }
  return all;
}

/// Kept while the camera sees the same in the same light, and for drafts after that.
void Session::State::update_bounced_places(const RenderInput& input) {
  const PrecomputeInput precompute{scene_, *world_, *rays_, plan_, input.monitor};
  KeyBuilder builder("bounced places", 2);
  builder.add(view_key(precompute, mesh_keys_));
  builder.add(surfaces_key(precompute, mesh_keys_, recentred_lights(scene_, *world_)));
  for (const Light& light : scene_.lights) builder.add(light.is_seen);  // else surfaces behind it are seen
  for (std::size_t b = 0; b < bodies_.size(); ++b)  // a method that was used before leaves its keys
    if (has_cells(bodies_[b].plan.method))
      builder.add(keys_[b].bounced_key);
    else
      builder.add(keys_[b].tree_key).add(keys_[b].kernel_key);
  // The keys of bodies say nothing where none are prepared.
  const StageKey key = is_needed() ? builder.key() : StageKey{};
  if (bounced_ != nullptr && key != StageKey{} && key == bounced_key_) return;
  std::optional<DirectlyLitBodies> directly_lit;
  if (is_needed()) directly_lit.emplace(bodies_, keys_, recentred_lights(scene_, *world_));
  bounced_ = opaline::bounced_places(input);
  bounced_key_ = key;
}

}  // namespace opaline
