// SPDX-License-Identifier: GPL-3.0-or-later
// Indirect light: at the samples of bodies and at cache points of the image.
#include <algorithm>
#include <memory>
#include <utility>

#include "input/settings_table.h"
#include "render/bounced_light.h"
#include "render/mirrored_light.h"
#include "session/session_state.h"
#include "stages/stage_codecs.h"

namespace opaline {
namespace {

void tint_bounced(const Body& body, std::span<RgbF> bounced) {
  for (std::size_t i = 0; i < body.entering.size(); ++i) bounced[i] = bounced[i] * body.entering[i];
}

/// Convergence of the bounces: light added by each, over all bodies and channels.
class BounceSeries {
 public:
  /// in    before, now: irradiance by all bounces so far, without and with the last; one list per body
  void add(std::span<const Body> bodies, const std::vector<std::vector<RgbF>>& before,
           const std::vector<std::vector<RgbF>>& now) {
    previous_ = last_;
    last_ = all_ = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b)
      for (std::size_t i = 0; i < now[b].size(); ++i) {
        const RgbF added = now[b][i] - (before.empty() ? RgbF{} : before[b][i]);
        const auto area = double(bodies[b].surface.samples[i].area);
        last_ += area * double(added.x + added.y + added.z);
        all_ += area * double(now[b][i].x + now[b][i].y + now[b][i].z);
      }
  }
  /// Ratio of two bounces.
  double ratio() const {
    constexpr double kLargest = .9;  // bound against noise
    return previous_ > 0 ? std::clamp(last_ / previous_, 0., kLargest) : 0;
  }
  /// Sum of all further bounces over the last one, as a geometric series.
  double rest() const { return ratio() / (1 - ratio()); }
  bool has_converged() const {
    constexpr double kLeast = .03;  // share of bounced light, itself a part of all light
    return !(last_ > 0) || (previous_ > 0 && last_ * rest() < kLeast * all_);
  }

 private:
  double previous_ = 0, last_ = 0, all_ = 0;
};

/// Replaces the light of bodies by their direct light, for gathering the first bounce; the destructor
/// restores it. An interrupted constructor leaves the bodies unchanged: it replaces nothing before everything
/// is computed, as no destructor would restore it.
class DirectlyLitBodies {
 public:
  explicit DirectlyLitBodies(std::span<BodyStages> bodies) : bodies_(bodies) {
    for (const BodyStages& stages : bodies)
      other_.push_back(method_of(stages.body.plan.method).direct_state(stages));
    exchange();
  }
  ~DirectlyLitBodies() { exchange(); }
  DirectlyLitBodies(const DirectlyLitBodies&) = delete;
  DirectlyLitBodies& operator=(const DirectlyLitBodies&) = delete;

 private:
  void exchange() noexcept {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      std::swap(bodies_[b].body.states.at(bodies_[b].body.plan.method), other_[b]);
  }

  std::span<BodyStages> bodies_;
  std::vector<std::unique_ptr<MethodState>> other_;  // one per body
};

}  // namespace

// Bounced light depends on all bodies.
void Session::State::update_bounces(std::span<BodyStages> bodies) {
  const PrecomputeInput& input = bodies.front().input;
  KeyBuilder all("bounces", 12);
  all.add(surfaces_key(input, mesh_keys_, bodies.front().lights));
  for (const Body& body : bodies_) all.add(method_of(body.plan.method).direct_key(body));
  std::vector<StageKey> wanted;
  bool is_there = true;
  for (const Body& body : bodies_) {
    const SubsurfaceMethod& method = method_of(body.plan.method);
    wanted.push_back(KeyBuilder("body with bounces", 1).add(all.key()).add(method.direct_key(body)).key());
    is_there = is_there && method.bounced_key(body) == wanted.back();
  }
  if (is_there) return;
  std::vector<std::vector<RgbF>> bounced = cached_bounces(wanted);
  if (bounced.empty()) {
    bounced = gathered_bounces(bodies);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      store_.keep(wanted[b], bounced[b], BouncedCodec{bounced[b].size()});
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    tint_bounced(bodies_[b], bounced[b]);
    method_of(bodies_[b].plan.method).add_bounced(bodies[b], bounced[b], wanted[b]);
    note_decision(bodies_[b], "light from other surfaces gathered");
  }
}

std::vector<std::vector<RgbF>> Session::State::gathered_bounces(std::span<BodyStages> bodies) {
  constexpr int kMostBounces = 8;
  const PrecomputeInput& input = bodies.front().input;
  for (BodyStages& stages : bodies) method_of(stages.body.plan.method).remove_bounced(stages);
  HeldView own;  // hits of the first bounce, for the others
  own.keeps_further_bounces = false;
  HeldView* const held = held_view_of_samples(input);
  HeldView* const view = held != nullptr ? held : &own;
  if (!std::ranges::all_of(bodies_,
                           [](const Body& body) { return method_of(body.plan.method).supports_reentry(); }))
    return bounced_at_samples(input, bodies_, MirroredByBodies::as_uniform, view);
  const std::vector<std::vector<RgbF>> mirrored = mirrored_at_samples(input, bodies_);
  const auto gathered = [&] {
    std::vector<std::vector<RgbF>> light =
        bounced_at_samples(input, bodies_, MirroredByBodies::of_surfaces, view);
    for (std::size_t b = 0; b < mirrored.size(); ++b)
      for (std::size_t i = 0; i < mirrored[b].size(); ++i) light[b][i] += mirrored[b][i];
    return light;
  };
  std::vector<std::vector<RgbF>> all = gathered();
  BounceSeries series;
  series.add(bodies_, {}, all);
  for (int bounce = 2; bounce <= kMostBounces && !series.has_converged(); ++bounce) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      std::vector<RgbF> tinted = all[b];
      tint_bounced(bodies_[b], tinted);
      method_of(bodies_[b].plan.method).add_for_gathering(bodies[b], tinted);
    }
    const std::vector<std::vector<RgbF>> before = std::exchange(all, gathered());
    series.add(bodies_, before, all);
    if (!series.has_converged() && bounce < kMostBounces) continue;
    const auto rest = float(series.rest());
    for (std::size_t b = 0; b < bodies.size(); ++b)
      for (std::size_t i = 0; i < all[b].size(); ++i)
        all[b][i] += component_max(all[b][i] - before[b][i], RgbF{}) * rest;
  }
  return all;
}

/// Cached view with the gathering of the bodies' current samples; null: caching is off.
HeldView* Session::State::held_view_of_samples(const PrecomputeInput& input) {
  HeldView* const view = held_view();
  if (view == nullptr) return nullptr;
  KeyBuilder builder("gathered at samples", 1);
  builder.add(settings_in_key(KeyedStage::gathered, scene_)).add(input.plan.rays);
  for (const MeshKeys& mesh : mesh_keys_) builder.add(mesh.all);
  for (const BodyKeys& known : keys_) builder.add(known.samples_key);
  const StageKey key = builder.key();
  if (key != view_samples_key_) view->at_samples.clear();
  view_samples_key_ = key;
  return view;
}

/// Bounced light of all bodies from the cache; empty: one of them is missing.
std::vector<std::vector<RgbF>> Session::State::cached_bounces(std::span<const StageKey> keys) {
  std::vector<std::vector<RgbF>> all;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    auto found = store_.find(keys[b], BouncedCodec{bodies_[b].surface.samples.size()});
    if (!found) return {};
    all.push_back(std::move(*found));
  }
  return all;
}

/// Reuses the cache points while the camera sees the same surfaces in the same light.
void Session::State::update_bounced_places(const RenderInput& input) {
  const PrecomputeInput precompute{scene_, *world_, *rays_, plan_, input.monitor};
  const std::vector<Light> lights = recentred_lights(scene_, *world_);
  KeyBuilder builder("bounced places", 2);
  builder.add(view_key(precompute, mesh_keys_)).add(surfaces_key(precompute, mesh_keys_, lights));
  for (const Light& light : scene_.lights) builder.add(light.is_seen);  // an invisible light hides no surface
  for (const Body& body : bodies()) {
    const SubsurfaceMethod& method = method_of(body.plan.method);
    builder.add(method.bounced_key(body)).add(method.direct_key(body));
  }
  // Keys of bodies are undefined without prepared bodies.
  const StageKey key = is_needed() ? builder.key() : StageKey{};
  if (bounced_ != nullptr && key != StageKey{} && key == bounced_key_) return;
  std::vector<BodyStages> stages = body_stages(precompute, lights);
  std::optional<DirectlyLitBodies> directly_lit;  // refers to the stages
  if (is_needed() && method_of(scene_.settings.method).needs_samples()) directly_lit.emplace(stages);
  bounced_ = opaline::bounced_places(input);
  bounced_key_ = key;
}

}  // namespace opaline
