// SPDX-License-Identifier: GPL-3.0-or-later
// The truth: what leaves a body by random walks inside of it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "opaline/core/monitor.h"
#include "opaline/geometry/ray_scene.h"
#include "opaline/sampling/sample_surface.h"
#include "opaline/scene/scene.h"
#include "opaline/volume/medium.h"

namespace opaline {

struct VolumeInput {
  const RayScene& rays;  ///< of the world
  const World& world;
  std::span<const std::uint32_t> meshes;   ///< the body's; all others stop light
  std::span<const SurfaceSample> samples;  ///< of the body; what leaves is counted on their Voronoi cells
  std::array<HomogeneousMedium, 3> media;  ///< R G B, in the world's unit of length
  std::span<const Light> lights;           ///< recentred
  std::optional<double> until_error = {};  ///< of VolumeExitance::relative_error; none: kDefaultWalks
  std::uint64_t seed = 0;
  Monitor* monitor = nullptr;
};

/// Walks a sample and channel where no error is asked for, and at the most.
inline constexpr std::size_t kDefaultWalks = 64, kMostWalks = 65536;

struct VolumeExitance {
  std::vector<RgbF> exitance;  ///< one a sample: radiant exitance, W/mm^2, the mean over its cell
  std::vector<RgbF> error;     ///< one a sample: standard error of the exitance
  std::size_t walks = 0;       ///< a sample and channel
  double relative_error = 0;   ///< rms over samples of error over sqrt(exitance^2 + (1 % of the largest)^2)
  Rgb lost{};                  ///< share of the entered light that got out through holes of the mesh
};

/// Light enters where it falls on the body, refracted by the geometric normal, walks until it is absorbed or
/// leaves, and what leaves is counted on the cell of the nearest sample of its sheet. Unbiased for the mean
/// over each cell; light that has left does not enter again. The same bits for any number of threads.
/// error Error{interrupted}
VolumeExitance volume_exitance(const VolumeInput& input);

}  // namespace opaline
