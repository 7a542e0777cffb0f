// SPDX-License-Identifier: GPL-3.0-or-later
// Of bodies whose light is followed inside: random walks, or diffusion in cells, and the fit through what leaves.
#include <algorithm>
#include <span>
#include <utility>

#include "opaline/lights/light.h"
#include "opaline/render/surface_textures.h"
#include "session/session_state.h"

namespace opaline {
namespace {

std::size_t passes_of(const VolumeSums& sums) {
  std::size_t passes = 0;
  for (const SourceSums& source : sums.sources)
    for (const WalkSums& channel : source.channels) passes += channel.passes;
  return passes;
}

}  // namespace

// Sums are of whole passes always: those that an interruption leaves stay.
void Session::State::update_walks(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                  const std::vector<Light>& lights) {
  VolumeInput walks = walk_input(input, body, lights);
  const StageKey tint = tint_key(scene_, *world_, body.plan.meshes, known.samples_key);
  std::optional<SurfaceTextures> textures;
  if (tint != StageKey{}) {
    textures.emplace(scene_, *world_);
    walks.entering_tint = [&](std::uint32_t mesh, std::uint32_t triangle, float u, float v) {
      return textures->tint(textures->place(mesh, triangle, u, v, {})).entering;
    };
  }
  const std::vector<StageKey> keys =
      walk_keys(walks, tint == StageKey{} ? known.samples_key : tint, inside_key(body), mesh_keys_);
  VolumeSums sums;
  for (const StageKey& key : keys) {
    const auto old = std::ranges::find(known.walk_keys, key);
    std::optional<SourceSums> found;
    if (old != known.walk_keys.end())
      found = std::move(body.walks.sources[std::size_t(old - known.walk_keys.begin())]);
    else if (walk_store_.find)
      found = walk_store_.find(key);
    sums.sources.push_back(found ? std::move(*found) : SourceSums());
  }
  body.walks = std::move(sums);
  known.walk_keys = keys;
  const std::size_t before = passes_of(body.walks);
  const auto keep = [&](const VolumeSums& now) {
    if (walk_store_.keep) walk_store_.keep(keys, now);
  };
  keep(body.walks);
  walk_volume(walks, body.walks, keep);
  const std::size_t passes = passes_of(body.walks);
  work_.walk_passes += passes - before;
  KeyBuilder key("exitance of random walks", 1);
  key.add_array(std::span(keys)).add(std::uint64_t(passes));
  for (const Light& light : lights) key.add(emission(light));
  if (key.key() != known.volume_key || !body.volume) {
    known.volume_key = {};
    body.volume = exitance_of(walks, body.walks);
    body.volume_fit = fit_of(body, known, body.volume->exitance, body.volume->error);
    known.volume_key = key.key();
  }
  note_decision(body, passes > before ? "walked at random" : "random walks kept");
}

/// Of how a body's medium varies.
StageKey Session::State::inside_key(const Body& body) const {
  return medium_key(scene_.media[body.plan.medium], scene_.settings.method, *world_, body.plan.meshes);
}

StageKey Session::State::cells_key(const Body& body, const BodyKeys& known) const {
  return diffusion_cells_key(body, known.samples_key, inside_key(body), mesh_keys_);
}

/// The cells at hand, or made anew where they are not the body's.
const VolumeDiffusion& Session::State::cells_of(const Body& body, BodyKeys& known,
                                                const PrecomputeInput& input) {
  const StageKey key = cells_key(body, known);
  if (known.diffusion == nullptr || known.diffusion_key != key)
    known.diffusion = std::make_shared<const VolumeDiffusion>(diffusion_of(input, body, known.cut_normals));
  known.diffusion_key = key;
  return *known.diffusion;
}

void Session::State::update_diffusion(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                      const std::vector<Light>& lights) {
  update_tint(body, known);
  const StageKey key = diffusion_key(cells_key(body, known),
                                     octree_key(known.samples_key, known.light_keys, lights, known.tint_key));
  if (key == known.volume_key) {
    if (bounces_of(scene_) == 0) forget_bounced(body, known);
    return note_decision(body, "diffusion kept");
  }
  known.volume_key = {};
  const VolumeDiffusion* const before = known.diffusion.get();
  std::optional<VolumeExitance> found;
  if (cache_ != nullptr) found = cache_->find_volume(key, body.surface.samples.size());
  if (found) {
    body.volume = std::move(found);
    ++work_.found;
    note_decision(body, "diffusion from the cache");
  } else {
    const VolumeDiffusion& cells = cells_of(body, known, input);
    body.volume = cells.exitance(lights, body.transfers, body.entering, input.monitor);
    if (cache_ != nullptr) cache_->keep_volume(key, *body.volume);
    note_decision(body, &cells == before ? "diffusion solved in the cells at hand" : "diffusion solved");
  }
  known.lit_fit = fit_of(body, known, body.volume->exitance, body.volume->error);
  forget_bounced(body, known);
  known.volume_key = key;
}

void Session::State::forget_bounced(Body& body, BodyKeys& known) {
  known.bounced_key = {};
  body.bounced.reset();
  body.volume_fit = known.lit_fit;
}

/// key: of what light that bounced adds
void Session::State::diffuse_bounced(Body& body, BodyKeys& known, const PrecomputeInput& input,
                                     std::span<const RgbF> bounced, const StageKey& key) {
  if (key == known.bounced_key) return;
  forget_bounced(body, known);
  std::optional<VolumeExitance> found;
  if (cache_ != nullptr) found = cache_->find_volume(key, body.surface.samples.size());
  work_.found += found ? 1 : 0;
  if (!found) {
    found = cells_of(body, known, input).exitance_of_even(bounced, input.monitor);
    if (cache_ != nullptr) cache_->keep_volume(key, *found);
  }
  body.bounced = std::move(found);
  std::vector<RgbF> all, errors;
  for (std::size_t i = 0; i < body.surface.samples.size(); ++i) {
    all.push_back(body.volume->exitance[i] + body.bounced->exitance[i]);
    errors.push_back(body.volume->error[i] + body.bounced->error[i]);
  }
  body.volume_fit = fit_of(body, known, all, errors);
  known.bounced_key = key;
}

// Where edits or a second fit are to come, what a fit takes of the samples' places alone is kept for them.
std::shared_ptr<const CellFit> Session::State::fit_of(const Body& body, BodyKeys& known,
                                                      std::span<const RgbF> means,
                                                      std::span<const RgbF> errors) const {
  if (!edits_ && bounces_of(scene_) == 0)
    return std::make_shared<const CellFit>(body.surface.samples, means, errors);
  if (known.cell_weights == nullptr || known.cell_weights_key != known.samples_key)
    known.cell_weights = std::make_shared<const CellWeights>(body.surface.samples);
  known.cell_weights_key = known.samples_key;
  return std::make_shared<const CellFit>(*known.cell_weights, means, errors);
}

}  // namespace opaline
