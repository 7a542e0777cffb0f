// SPDX-License-Identifier: GPL-3.0-or-later
// One group's results, each with its key; a key of zeros stands for a result that is not there.
#pragma once

#include "opaline/session/session.h"

namespace opaline {

/// Samples that were placed anew, and where: others are carried from them.
struct SampleOrigin {
  std::shared_ptr<const World> world;
  std::vector<std::uint32_t> meshes;  // in that world
  StageKey key;
  std::uint64_t seed = 0;
  std::size_t count = 0;       // asked for
  double area = 0;             // of the surface then, mm^2
  SurfaceSamples surface;      // while the part's own are carried; else the part's own are these
  SurfaceCells cells;          // of these samples; empty until a surface bends where no edits were expected
  bool count_was_set = false;  // by settings.samples
  std::optional<double> spacing_setting;
};

/// Whether the body no longer suits the spacing that carried samples keep: there would be more of them than
/// the scene allows, or, where the scene sets their number, a small part of that.
bool has_outgrown(const SampleOrigin& origin, const GroupPlan& plan, const Settings& settings);

struct Session::Part {
  GroupPlan plan;
  DiffuseProfile profile;
  SampleOrigin origin;
  StageKey samples_key, tree_key, kernel_key;
  SurfaceSamples surface;
  std::vector<std::uint32_t> meshes;  // that the surface's samples name
  std::vector<StageKey> light_keys;
  std::vector<LightTransfer> transfers;  // one a light
  std::vector<RgbF> irradiance;
  Octree octree;
  std::optional<SplitKernel> kernel;
  StageKey exitance_key;
  std::optional<SurfaceCache> surface_cache;  // the group's while it is of use for the picture

  bool is_carried() const { return samples_key != origin.key; }
};

}  // namespace opaline
