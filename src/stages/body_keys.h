// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of one body's samples and of the light transmitted there; a key of zeros: no result.
#pragma once

#include <cstdint>

#include "bodies/body.h"
#include "sampling/carry_samples.h"
#include "stages/stage_keys.h"

namespace opaline {

/// Last complete sampling of a body, the origin of carried samples.
struct SampleOrigin {
  std::shared_ptr<const World> world;
  std::vector<std::uint32_t> meshes;  // indices in that world
  StageKey key, placement;
  std::size_t count = 0;       // requested
  double area = 0;             // area of the surface at that time, mm^2
  SurfaceSamples surface;      // while the body's own are carried; otherwise the body's own are these
  SurfaceCells cells;          // cells of these samples; empty until a surface deforms without expected edits
  bool count_was_set = false;  // by settings.samples
  std::optional<double> spacing_setting;
};

/// True if the body no longer fits the spacing of carried samples: they would exceed the scene's limit, or,
/// with a set number, be a small fraction of it.
bool has_outgrown(const SampleOrigin& origin, const BodyPlan& plan, const Settings& settings);

/// Keys of the stages shared by all methods.
struct BodyKeys {
  SampleOrigin origin;
  StageKey samples_key, tint_key;
  std::vector<std::uint32_t> meshes;  // meshes of the samples
  std::vector<StageKey> light_keys;   // keys of the transfers
  std::vector<Vec3f> cut_normals;     // normals of cut surfaces' samples

  bool is_carried() const { return samples_key != origin.key; }
};

}  // namespace opaline
