// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/volume_diffusion/volume_diffusion_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "bodies/local_media.h"
#include "bodies/opaque_inside.h"
#include "bodies/surface_textures.h"
#include "input/settings_table.h"
#include "methods/volume/cell_field.h"
#include "methods/volume/cell_warnings.h"
#include "methods/volume_diffusion/volume_diffusion_state.h"
#include "scene/scene_properties.h"
#include "stages/stage_codecs.h"
#include "volume/volume_diffusion.h"

namespace opaline {
namespace {

HomogeneousMedium isotropic_medium(const ReducedMedium& reduced) {
  const double length = reduced.mean_free_path;
  if (!(length > 0)) return {0, 0, 0, reduced.eta};
  return {reduced.absorbed / length, (1 - reduced.absorbed) / length, 0, reduced.eta};
}

/// In the world's unit.
std::array<HomogeneousMedium, 3> isotropic_media(const DiffuseProfile& profile) {
  std::array<HomogeneousMedium, 3> media;
  for (std::size_t c = 0; c < 3; ++c) {
    const double decay =
        profile.mean_free_path[c] / profile.diffuse_mean_free_path[c];  // its square is 3 (1 - alpha')
    media[c] = isotropic_medium({profile.mean_free_path[c], decay * decay / 3, profile.eta});
  }
  return media;
}

/// Cells with the media of the body.
/// In a heterogeneous medium, mean free paths below the cells' resolution are lengthened to it, with the same
/// reflectance; the point of exit is known within a cell anyway.
/// in    body: with the samples of its cut surface; normals: of the same surface; opaque: opaque_inside
VolumeDiffusion body_cells(const PrecomputeInput& input, const Body& body, std::span<const Vec3f> normals,
                           std::vector<std::uint32_t> opaque) {
  const double cell = body.plan.cell / input.world.unit, least = cell / input.scene.settings.cell_size;
  const bool has_layers = !input.scene.media[body.plan.medium].layers.empty();
  const auto resolved = [least, has_layers](ReducedMedium reduced) {
    if (has_layers) return isotropic_medium(reduced);  // thin layers keep their optical thickness
    const double length = length_to_resolve(reduced.mean_free_path, reduced.absorbed);
    if (!(length > 0))
      reduced.mean_free_path = least / length_to_resolve(1, reduced.absorbed);
    else if (length < least)
      reduced.mean_free_path *= least / length;
    return isotropic_medium(reduced);
  };
  const std::array<HomogeneousMedium, 3> media = isotropic_media(body.profile);
  MediaInside inside = media_inside(input, body, CubeCentre::inside, resolved);
  const bool is_varying = bool(inside);
  if (!opaque.empty())
    inside = with_opaque_shapes(input.world, input.rays, std::move(opaque), std::move(inside), media);
  return VolumeDiffusion({input.world, body.plan.meshes, body.surface.samples, normals, media, cell,
                          std::move(inside), has_layers || !is_varying});
}

// Raise a stage's number when it computes other values from the same input (test_stage_versions).
constexpr std::uint64_t kCellsVersion = 7, kDiffusionVersion = 12;

/// Found anew only if a mesh has changed.
const std::vector<std::uint32_t>& update_opaque(BodyStages& stages) {
  const PrecomputeInput& input = stages.input;
  const BodyPlan& body = stages.body.plan;
  KeyBuilder key("opaque inside", 1);
  for (const std::uint32_t mesh : body.meshes) key.add(stages.mesh_keys[mesh].shape);
  for (const std::uint32_t mesh : opaque_beside(input.scene, input.world, body))
    key.add(mesh).add(stages.mesh_keys[mesh].shape);
  auto& opaque = state_of<VolumeDiffusionState>(stages.body).opaque;
  stages.store.get(opaque, key.key(),
                   [&] { return opaque_inside(input.scene, input.world, input.rays, body); });
  return opaque.value;
}

StageKey cells_key(BodyStages& stages) {
  const Body& body = stages.body;
  const StageKey medium_inside = medium_key(stages.input.scene, stages.input.world, body.plan.meshes);
  KeyBuilder key("diffusion cells", kCellsVersion);
  key.add(settings_in_key(KeyedStage::cells, stages.input.scene));
  key.add(stages.keys.samples_key).add(body.profile.eta).add(body.plan.cell);
  key.add(body.profile.mean_free_path).add(body.profile.diffuse_mean_free_path);
  if (medium_inside != StageKey{}) key.add(medium_inside);
  for (const std::uint32_t mesh : body.plan.meshes) key.add(stages.mesh_keys[mesh].shape);
  for (const std::uint32_t mesh : update_opaque(stages)) key.add("opaque").add(stages.mesh_keys[mesh].shape);
  return key.key();
}

const VolumeDiffusion& update_cells(BodyStages& stages) {
  auto& cells = state_of<VolumeDiffusionState>(stages.body).cells;
  stages.store.get(cells, cells_key(stages), [&] {
    return std::make_shared<const VolumeDiffusion>(
        body_cells(stages.input, stages.body, stages.keys.cut_normals, update_opaque(stages)));
  });
  return *cells.value;
}

/// Diffuse reflectance of the channels without a mean free path, which is below the resolution of cells.
RgbF local_reflectance(const Scene& scene, const Body& body) {
  RgbF local;
  if (varies_inside(scene.media[body.plan.medium])) return local;
  for (std::size_t c = 0; c < 3; ++c)
    if (is_local(body.profile, c)) local[c] = float(body.profile.total[c]);
  return local;
}

/// Exitance by lights and another one.
std::vector<RgbF> with_bounced(const VolumeDiffusionState& state, std::span<const RgbF> bounced) {
  std::vector<RgbF> all = state.direct.value.exitance;
  for (std::size_t i = 0; i < bounced.size(); ++i) all[i] += bounced[i];
  return all;
}

CellMeans means_of(const BodyStages& stages, std::vector<RgbF> exitance) {
  auto& nearest = state_of<VolumeDiffusionState>(stages.body).nearest;
  stages.store.get(nearest, stages.keys.samples_key, [&] {
    // Cells cut to slivers are inaccurate, and they are the nearest to larger areas than theirs.
    constexpr double kLeastArea = .2;
    return std::make_shared<const NearestSample>(
        NearestSample::by_centroids(stages.body.surface.samples, 1, kLeastArea));
  });
  return {nearest.value, std::move(exitance)};
}

/// Makes gathered rays meet this exitance.
void set_seen(BodyStages& stages, std::vector<RgbF> exitance) {
  auto& state = state_of<VolumeDiffusionState>(stages.body);
  state.fit = nullptr;
  state.seen = means_of(stages, std::move(exitance));
}

void set_fit(BodyStages& stages, std::span<const RgbF> exitance) {
  auto& state = state_of<VolumeDiffusionState>(stages.body);
  state.fit = nullptr;  // if interrupted
  state.fit = fit_cells(stages, state.weights, exitance, state.direct.value.error);
  state.seen = {};
}

}  // namespace

const VolumeDiffusionState& volume_diffusion_state(const Body& body) {
  return state_of<VolumeDiffusionState>(body);
}

void VolumeDiffusionMethod::prepare(BodyStages& stages) const {
  auto& state = state_of<VolumeDiffusionState>(stages.body);
  const Body& body = stages.body;
  const StageKey cells = cells_key(stages);
  const StageKey key =
      KeyBuilder("diffusion", kDiffusionVersion).add(cells).add(stages.transmitted_key()).key();
  const bool has_cells = state.cells.value != nullptr && state.cells.key == cells;
  const ResultSource source =
      stages.store.get(state.direct, key, VolumeCodec{body.surface.samples.size()}, [&] {
        return update_cells(stages).exitance(stages.lights, body.transfers, body.entering,
                                             stages.input.monitor);
      });
  const bool has_bounced = state.bounced.key != StageKey{},
             gathers = gathers_light(stages.input.scene, body.plan);
  if (source != ResultSource::reused || (has_bounced && !gathers)) {
    state.bounced = {};
    state.fit = nullptr;
  }
  if (!gathers && state.fit == nullptr) set_fit(stages, state.direct.value.exitance);
  stages.note("diffusion", source, has_cells ? "solved on the existing cells" : "solved");
}

StageKey VolumeDiffusionMethod::direct_key(const Body& body) const {
  return volume_diffusion_state(body).direct.key;
}

StageKey VolumeDiffusionMethod::bounced_key(const Body& body) const {
  return volume_diffusion_state(body).bounced.key;
}

void VolumeDiffusionMethod::remove_bounced(BodyStages& stages) const {
  auto& state = state_of<VolumeDiffusionState>(stages.body);
  state.bounced = {};
  set_seen(stages, state.direct.value.exitance);
}

void VolumeDiffusionMethod::add_bounced(BodyStages& stages, std::span<const RgbF> bounced,
                                        const StageKey& key) const {
  auto& state = state_of<VolumeDiffusionState>(stages.body);
  if (state.bounced.key == key) return;
  StageResult<VolumeExitance> added;
  if (std::ranges::all_of(bounced, [](const RgbF& irradiance) { return irradiance == RgbF{}; }))
    added.key = key;
  else
    stages.store.get(added, key, VolumeCodec{stages.body.surface.samples.size()}, [&] {
      return update_cells(stages).exitance_of_even(bounced, state.direct.value.exitance,
                                                   stages.input.monitor);
    });
  set_fit(stages, with_bounced(state, added.value.exitance));
  state.bounced = std::move(added);
}

void VolumeDiffusionMethod::add_for_gathering(BodyStages& stages, std::span<const RgbF> bounced) const {
  const auto& state = state_of<VolumeDiffusionState>(stages.body);
  const VolumeExitance added =
      update_cells(stages).exitance_of_even(bounced, state.direct.value.exitance, stages.input.monitor);
  set_seen(stages, with_bounced(state, added.exitance));
}

std::unique_ptr<MethodState> VolumeDiffusionMethod::direct_state(const BodyStages& stages) const {
  auto direct = std::make_unique<VolumeDiffusionState>();
  const VolumeDiffusionState& state = volume_diffusion_state(stages.body);
  direct->seen = means_of(stages, state.direct.value.exitance);
  return direct;
}

bool VolumeDiffusionMethod::finish(BodyStages& stages) const {
  auto& state = state_of<VolumeDiffusionState>(stages.body);
  if (!stages.expects_edits) {
    state.cells = {};
    state.weights = {};
  }
  return false;
}

std::vector<std::string> VolumeDiffusionMethod::warnings(const Body& body, double unit) const {
  constexpr double kLeastLeftOut = 1e-4;  // fraction of the area: above rounding
  std::vector<std::string> warnings;
  const double left_out =
      body.surface.samples.empty() ? 0 : 1 - body.surface.area * unit * unit / body.plan.area;
  if (left_out > kLeastLeftOut)
    warnings.push_back(fmt::format(
        "{}: {:.2g} % of the surface lies inside the body or overlaps itself; volume_diffusion ignores it",
        body.plan.name, 100 * left_out));
  for (std::string& warning : cell_warnings(body, volume_diffusion_state(body).direct.value))
    warnings.push_back(std::move(warning));
  return warnings;
}

std::vector<RgbF> VolumeDiffusionMethod::exitance_at(const Body& body, std::span<const Query> points,
                                                     const Settings&) const {
  return fit_at(*volume_diffusion_state(body).fit, points);
}

std::unique_ptr<Field> VolumeDiffusionMethod::field(const RenderInput& input, const Body& body) const {
  const VolumeDiffusionState& state = volume_diffusion_state(body);
  const RgbF local = local_reflectance(input.scene, body);
  if (state.fit == nullptr) return std::make_unique<NearestCellField>(input, body, state.seen, local);
  return std::make_unique<FittedCellField>(input, body, *state.fit, local);
}
}  // namespace opaline
