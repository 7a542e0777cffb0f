// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of one body's results; a key of zeros stands for a result that is not there.
#pragma once

#include <cstdint>

#include "opaline/render/precompute.h"
#include "opaline/sampling/carry_samples.h"
#include "opaline/session/stage_keys.h"

namespace opaline {

/// Samples that were placed anew, and where: others are carried from them.
struct SampleOrigin {
  std::shared_ptr<const World> world;
  std::vector<std::uint32_t> meshes;  // in that world
  StageKey key;
  std::uint64_t seed = 0;
  std::size_t count = 0;       // asked for
  double area = 0;             // of the surface then, mm^2
  SurfaceSamples surface;      // while the body's own are carried; else the body's own are these
  SurfaceCells cells;          // of these samples; empty until a surface bends where no edits were expected
  bool count_was_set = false;  // by settings.samples
  std::optional<double> spacing_setting;
};

/// Whether the body no longer suits the spacing that carried samples keep: there would be more of them than
/// the scene allows, or, where the scene sets their number, a small part of that.
bool has_outgrown(const SampleOrigin& origin, const GroupPlan& plan, const Settings& settings);

/// What a body's results were computed from.
struct BodyKeys {
  SampleOrigin origin;
  StageKey samples_key, tint_key, tree_key, kernel_key, exitance_key;
  StageKey lights_key;                      // of the tree before bounced light is added
  StageKey volume_key;                      // of Body::volume; of walks, but for their number
  StageKey diffusion_key;                   // of the cells
  StageKey bounced_key;                     // of Body::bounced
  std::vector<std::uint32_t> meshes;        // that the samples name
  std::vector<StageKey> light_keys;         // of the transfers
  std::vector<StageKey> walk_keys;          // of the walks' sources
  std::optional<SurfaceCache> spare_cache;  // kept, though this picture does not use it

  std::shared_ptr<const VolumeDiffusion> diffusion;  // its cells
  std::shared_ptr<const CellFit> lit_fit;            // of Body::volume alone
  std::vector<Vec3f> cut_normals;                    // of the samples, where cells cut the surface
  std::shared_ptr<const CellWeights> cell_weights;   // of the samples
  StageKey cell_weights_key;                         // samples_key with which they were found

  bool is_carried() const { return samples_key != origin.key; }
};

}  // namespace opaline
