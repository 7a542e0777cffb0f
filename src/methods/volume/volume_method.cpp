// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/volume/volume_method.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "bodies/surface_textures.h"
#include "input/settings_table.h"
#include "lights/light.h"
#include "lights/light_tree.h"
#include "methods/volume/cell_field.h"
#include "methods/volume/cell_warnings.h"
#include "methods/volume/volume_state.h"
#include "methods/volume/walk_input.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

// Raise when walks compute other values from the same input (test_stage_versions).
constexpr std::uint64_t kWalksVersion = 3;

/// Keys of the sums, one for each of their sources: the samples (or their tint), the media, all meshes, the
/// position and size of the source's light; its colour only where sources have several lights.
std::vector<StageKey> walk_keys(const BodyStages& stages, const VolumeInput& walks, const StageKey& tint) {
  const StageKey medium_inside = medium_key(stages.input.scene, stages.input.world, stages.body.plan.meshes);
  KeyBuilder common("random walks", kWalksVersion);
  common.add(embree_version()).add(std::string(widest_instructions()));
  common.add(tint == StageKey{} ? stages.keys.samples_key : tint);
  common.add(settings_in_key(KeyedStage::walks, stages.input.scene));
  for (const HomogeneousMedium& medium : walks.media) common.add(medium);
  if (medium_inside != StageKey{}) common.add(medium_inside);
  const Scene& scene = stages.input.scene;
  add_fuzz(common, scene, stages.input.world, scene.media[stages.body.plan.medium].fuzz, walks.meshes);
  add_maps(common, scene, stages.input.world, walks.meshes);
  for (const std::uint32_t m : walks.meshes) common.add(m);
  for (const MeshKeys& mesh : stages.mesh_keys) common.add(mesh.shape);
  const bool alone = walks_by_light(walks);
  std::vector<StageKey> keys;
  for (std::size_t l = 0; l < walks.lights.size() && (alone || l == 0); ++l) {
    KeyBuilder key("random walks of lights", kWalksVersion);
    key.add(common.key());
    for (const Light& light : alone ? walks.lights.subspan(l, 1) : walks.lights) {
      key.add(std::uint64_t(light.source.index())).add(light.name);
      key.add_array(std::span<const double>(geometry(light)));
      if (!alone) key.add(emission(light));
    }
    keys.push_back(key.key());
  }
  return keys;
}

std::size_t passes_of(const VolumeSums& sums) {
  std::size_t passes = 0;
  for (const SourceSums& source : sums.sources)
    for (const WalkSums& channel : source.channels) passes += channel.passes;
  return passes;
}

/// Sums of previous images or of the store; empty ones for new sources, and where a damaged file has other numbers of
/// samples.
VolumeSums known_sums(VolumeState& state, const WalkStore& store, std::span<const StageKey> keys,
                      std::size_t samples) {
  const auto fits = [&](const WalkSums& sums) {
    return sums.passes == 0 || (sums.flux.size() == samples && sums.roots.size() == samples);
  };
  VolumeSums sums;
  for (const StageKey& key : keys) {
    const auto old = std::ranges::find(state.walk_keys, key);
    std::optional<SourceSums> found;
    if (old != state.walk_keys.end())
      found = std::move(state.walks.sources[std::size_t(old - state.walk_keys.begin())]);
    else if (store.find)
      found = store.find(key);
    if (found && !std::ranges::all_of(found->channels, fits)) found.reset();
    sums.sources.push_back(found ? std::move(*found) : SourceSums());
  }
  return sums;
}

void walk_share(const VolumeInput& walks, std::span<const StageKey> keys, const WalkShare& share) {
  walk_passes(
      walks, share.first, share.last,
      [&](const WalkPass& pass) { return share.is_known(keys[pass.source], pass.channel, pass.pass); },
      [&](const WalkPass& pass, PassSums sums) {
        share.keep(keys[pass.source], pass.channel, pass.pass, std::move(sums));
      });
}

/// Fit of the cells at the boundary of the solid.
std::shared_ptr<const CellFit> fit_of(BodyStages& stages, const VolumeExitance& exitance,
                                      ReusedWeights& weights) {
  if (exitance.outer_shares.empty()) return fit_cells(stages, weights, exitance.exitance, exitance.error);
  std::vector<SurfaceSample> samples;
  std::vector<RgbF> means, errors;
  for (std::size_t i = 0; i < exitance.outer_shares.size(); ++i) {
    if (is_mostly_inside(exitance.outer_shares[i])) continue;
    samples.push_back(stages.body.surface.samples[i]);
    means.push_back(exitance.exitance[i]);
    errors.push_back(exitance.error[i]);
  }
  return std::make_shared<const CellFit>(samples, means, errors);
}

}  // namespace

const VolumeState& volume_state(const Body& body) {
  return state_of<VolumeState>(body);
}

// Sums consist of whole passes: an interruption keeps the complete ones.
void VolumeMethod::prepare(BodyStages& stages) const {
  const PrecomputeInput& input = stages.input;
  auto& state = state_of<VolumeState>(stages.body);
  VolumeInput walks = walk_input(input, stages.body, stages.lights);
  std::optional<SurfaceTextures> textures;
  const StageKey tint = tint_key(input.scene, input.world, stages.body.plan.meshes, stages.keys.samples_key);
  const bool is_bent = has_maps(input.scene, stages.body.plan.meshes);
  if (tint != StageKey{} || is_bent) textures.emplace(input.scene, input.world);
  if (is_bent) walks.bend = [&](SurfacePoint& point) { return textures->bend(point); };
  if (tint != StageKey{}) {
    walks.entering_tint = [&](std::uint32_t mesh, std::uint32_t triangle, float u, float v) {
      return textures->tint(textures->place(mesh, triangle, u, v, {})).entering;
    };
  }
  const std::vector<StageKey> keys = walk_keys(stages, walks, tint);
  state.walks = known_sums(state, stages.walks, keys, walks.samples.size());
  state.walk_keys = keys;
  const std::size_t before = passes_of(state.walks);
  const auto keep = [&](const VolumeSums& now) {
    if (stages.walks.keep) stages.walks.keep(keys, now);
  };
  keep(state.walks);
  if (stages.walks.share) return walk_share(walks, keys, *stages.walks.share);
  walk_volume(walks, state.walks, keep);
  const std::size_t passes = passes_of(state.walks);
  stages.store.work().walk_passes += passes - before;
  KeyBuilder key("exitance of random walks", 1);
  key.add_array(std::span(keys)).add(std::uint64_t(passes));
  for (const Light& light : stages.lights) key.add(emission(light));
  stages.store.get(state.exitance, key.key(), [&] {
    VolumeExitance exitance = exitance_of(walks, state.walks);
    state.fit = fit_of(stages, exitance, state.weights);
    return exitance;
  });
  stages.note(passes > before ? "random walks traced" : "random walks reused");
}

bool VolumeMethod::finish(BodyStages& stages) const {
  if (!stages.expects_edits) state_of<VolumeState>(stages.body).weights = {};
  return false;
}

std::vector<std::string> VolumeMethod::warnings(const Body& body, double) const {
  return cell_warnings(body, volume_state(body).exitance.value);
}

std::vector<RgbF> VolumeMethod::exitance_at(const Body& body, std::span<const Query> points,
                                            const Settings&) const {
  return fit_at(*volume_state(body).fit, points);
}

std::unique_ptr<Field> VolumeMethod::field(const RenderInput& input, const Body& body) const {
  return std::make_unique<FittedCellField>(input, body, *volume_state(body).fit, RgbF{});
}

}  // namespace opaline
