// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of one body's samples and of the light transmitted there; a key of zeros: no result.
#pragma once

#include <cstdint>

#include "bodies/body.h"
#include "sampling/carry_samples.h"
#include "stages/stage_keys.h"

namespace opaline {

/// Samples that were placed anew, and where: others are carried from them.
struct SampleOrigin {
  std::shared_ptr<const World> world;
  std::vector<std::uint32_t> meshes;  // in that world
  StageKey key;
  std::uint64_t seed = 0;
  std::size_t count = 0;   // asked for
  double area = 0;         // area of the surface then, mm^2
  SurfaceSamples surface;  // while the body's own are carried; else the body's own are these
  SurfaceCells cells;      // cells of these samples; empty until a surface bends where no edits were expected
  bool count_was_set = false;  // by settings.samples
  std::optional<double> spacing_setting;
};

/// True if the body no longer suits the spacing that carried samples keep: there would be more of them than
/// the scene allows, or, where the scene sets their number, a small part of that.
bool has_outgrown(const SampleOrigin& origin, const GroupPlan& plan, const Settings& settings);

/// Keys of the stages that all methods share.
struct BodyKeys {
  SampleOrigin origin;
  StageKey samples_key, tint_key;
  std::vector<std::uint32_t> meshes;  // that the samples name
  std::vector<StageKey> light_keys;   // keys of the transfers
  std::vector<Vec3f> cut_normals;     // cut normals of the samples, where cells cut the surface

  bool is_carried() const { return samples_key != origin.key; }
};

}  // namespace opaline
