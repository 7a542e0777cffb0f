// SPDX-License-Identifier: GPL-3.0-or-later
// Stages shared by all methods: samples and their transmitted light. A result gets its key once it is
// complete.
#include <fmt/format.h>

#include "bodies/surface_textures.h"
#include "sampling/carry_samples.h"
#include "session/session_state.h"
#include "stages/stage_codecs.h"

namespace opaline {
namespace {

bool is_from_this_plan(const SampleOrigin& origin, const PrecomputeInput& input, std::size_t group) {
  return origin.key != StageKey{} && origin.placement == placement_key(input, group);
}

void renumber(std::vector<SurfaceSample>& samples, const std::vector<std::uint32_t>& from,
              const std::vector<std::uint32_t>& to) {
  if (from == to) return;
  for (SurfaceSample& s : samples) s.mesh = to[std::size_t(std::ranges::find(from, s.mesh) - from.begin())];
}

/// Number of samples on the stretched surface at their current spacing.
std::size_t carried_count(const SampleOrigin& origin, const BodyPlan& plan) {
  const double stretched = origin.area > 0 ? std::max(1.0, plan.area / origin.area) : 1;
  return std::size_t(std::min(1e9, double(origin.surface.samples.size()) * stretched));
}

}  // namespace

bool has_outgrown(const SampleOrigin& origin, const BodyPlan& plan, const Settings& settings) {
  constexpr double kMore = 2;          // factor on the number, if above the scene's maximum
  constexpr double kFewer = 1.0 / 16;  // fraction of the number: spacing four times as large as requested
  if (!(origin.area > 0)) return false;
  const double count = double(origin.count), carried = count * (plan.area / origin.area);
  const bool by_number = origin.count_was_set || origin.count >= settings.max_samples;
  return carried > std::max(double(settings.max_samples), kMore * count) ||
         (by_number && carried < kFewer * count);
}

void Session::State::update_samples(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                    std::size_t group) {
  if (body.plan.cell > 0) return cut_new_samples(body, known, input);
  const StageKey placed = samples_key(input, mesh_keys_, group);
  if (placed == known.samples_key) return reuse_samples(body, known);
  if (placed == known.origin.key) {  // back at the original position
    body.surface = std::move(known.origin.surface);
    known.meshes = known.origin.meshes;
    known.samples_key = placed;
    return reuse_samples(body, known);
  }
  if (matches_new_ || !is_from_this_plan(known.origin, input, group) ||
      has_outgrown(known.origin, body.plan, input.scene.settings) ||
      !can_carry(*known.origin.world, known.origin.meshes, *world_, body.plan.meshes))
    return place_new_samples(body, known, input, group, placed);
  const StageKey carried =
      carried_samples_key(known.origin.key, body.plan, mesh_keys_, known.origin.world->unit / world_->unit);
  if (carried == known.samples_key) return reuse_samples(body, known);
  carry_samples(body, known, input, carried);
}

void Session::State::reuse_samples(Body& body, BodyKeys& known) {
  renumber(body.surface.samples, known.meshes, body.plan.meshes);
  known.meshes = body.plan.meshes;
  if (!known.is_carried()) {
    known.origin.world = world_;
    known.origin.meshes = known.meshes;
  }
  note_decision(body, fmt::format("{} samples reused", body.surface.samples.size()));
}

// Negligible compared with later stages, so not cached.
void Session::State::cut_new_samples(Body& body, BodyKeys& known, const PrecomputeInput& input) {
  const StageKey key = cut_surface_key(body.plan, mesh_keys_, world_->unit);
  if (key == known.samples_key) return reuse_samples(body, known);
  if (anchored_ && !known.is_carried()) known.origin.surface = std::move(body.surface);
  if (!anchored_) known.origin = {};
  known.samples_key = {};
  CutSurface cut = body_cut_surface(input, body);
  body.surface = std::move(cut.surface);
  known.cut_normals = std::move(cut.normals);
  known.meshes = body.plan.meshes;
  known.samples_key = key;
  work_.samples_placed += body.surface.samples.size();
  note_decision(body, fmt::format("{} samples placed", body.surface.samples.size()));
}

void Session::State::place_new_samples(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                       std::size_t group, const StageKey& key) {
  const Settings& settings = input.scene.settings;
  if (anchored_ && !known.is_carried()) known.origin.surface = std::move(body.surface);
  known.samples_key = {};
  if (!anchored_) known.origin = {};
  SurfaceCells cells;
  const SamplesCodec codec{{*world_, body.plan.meshes, body.plan.samples}};
  std::optional<SurfaceSamples> found = store_.find(key, codec);
  if (found) {
    body.surface = std::move(*found);
  } else {
    body.surface = place_samples(input, group, edits_ && !anchored_ ? &cells : nullptr);
    work_.samples_placed += body.surface.samples.size();
    work_.samples_divided += body.surface.samples.size();
    store_.keep(key, body.surface, codec);
  }
  known.meshes = body.plan.meshes;
  if (!anchored_)
    known.origin = {world_,
                    known.meshes,
                    key,
                    placement_key(input, group),
                    body.plan.samples,
                    body.surface.area * world_->unit * world_->unit,
                    {},
                    std::move(cells),
                    settings.samples.has_value(),
                    settings.sample_spacing};
  known.samples_key = key;
  note_decision(
      body, fmt::format("{} samples {}", body.surface.samples.size(), found ? "from the cache" : "placed"));
}

void Session::State::carry_samples(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                   const StageKey& key) {
  if (!known.is_carried()) known.origin.surface = std::move(body.surface);
  known.samples_key = {};
  const SamplesCodec codec{{*world_, body.plan.meshes, carried_count(known.origin, body.plan)}};
  if (auto found = store_.find(key, codec)) {
    body.surface = std::move(*found);
    note_decision(body, fmt::format("{} samples from the cache", body.surface.samples.size()));
  } else {
    CarriedSamples carried =
        opaline::carry_samples({*known.origin.world, known.origin.meshes, *world_, body.plan.meshes,
                                known.origin.surface, known.origin.cells, input.monitor});
    body.surface = std::move(carried.surface);
    work_.samples_carried += body.surface.samples.size() - carried.added;
    work_.samples_placed += carried.added;
    work_.samples_removed += carried.removed;
    work_.samples_divided += carried.divided ? body.surface.samples.size() : 0;
    store_.keep(key, body.surface, codec);
    note_decision(body, carried.rigid
                            ? fmt::format("{} samples moved with the surface", body.surface.samples.size())
                            : fmt::format("{} samples moved with the surface, {} added, {} removed",
                                          body.surface.samples.size(), carried.added, carried.removed));
  }
  known.meshes = body.plan.meshes;
  known.samples_key = key;
}

void Session::State::update_lights(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                   std::size_t group, const std::vector<Light>& lights) {
  const LightCodec codec{body.surface.samples.size()};
  std::vector<StageKey> keys;
  std::vector<LightTransfer> transfers(lights.size());
  std::vector<Light> missing;
  std::vector<std::size_t> places;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    keys.push_back(transfer_key(input, known.samples_key, mesh_keys_, group, lights[l]));
    const auto old = std::ranges::find(known.light_keys, keys[l]);
    if (old != known.light_keys.end()) {
      transfers[l] = body.transfers[std::size_t(old - known.light_keys.begin())];
      note_decision(body, fmt::format("irradiance of {} reused", lights[l].name));
    } else if (auto found = store_.find(keys[l], codec)) {
      transfers[l] = std::move(*found);
      note_decision(body, fmt::format("irradiance of {} from the cache", lights[l].name));
    } else {
      missing.push_back(lights[l]);
      places.push_back(l);
      note_decision(body, fmt::format("irradiance of {} traced", lights[l].name));
    }
  }
  if (!missing.empty()) {
    const std::uint64_t before = rays_->statistics().rays;
    std::vector<LightTransfer> traced =
        trace_transfers(input, group, body.boundary, body.surface.samples, missing);
    work_.sample_rays += rays_->statistics().rays - before;
    work_.lights_traced += missing.size();
    for (std::size_t i = 0; i < missing.size(); ++i) {
      store_.keep(keys[places[i]], traced[i], codec);
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

}  // namespace opaline
