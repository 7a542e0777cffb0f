// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance of a body by random walks inside it: the reference.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"
#include "opaline/monitor.h"
#include "opaline/scene.h"
#include "sampling/sample_surface.h"
#include "transport/medium.h"
#include "transport/outer_boundary.h"
#include "volume/media_inside.h"

namespace opaline {

struct VolumeInput {
  const RayScene& rays;  ///< ray structure of the world
  const World& world;
  std::span<const std::uint32_t> meshes;   ///< meshes of the body; all others absorb light
  std::span<const SurfaceSample> samples;  ///< Voronoi cells collecting the exitance
  std::array<HomogeneousMedium, 3> media;  ///< R G B, in the world's unit of length
  std::span<const Light> lights;           ///< recentred
  std::optional<double> until_error = {};  ///< bound of VolumeExitance::relative_error; none: kDefaultWalks
  std::uint64_t seed = 0;
  Monitor* monitor = nullptr;
  bool reenter = true;  ///< enables re-entry of light into the body
  /// Factor on incident light by position: mesh, triangle and barycentrics. Empty: none.
  std::function<RgbF(std::uint32_t mesh, std::uint32_t triangle, float u, float v)> entering_tint = {};
  /// Turns the normal of a point by maps; returns a factor of the light entering. Empty: no maps.
  std::function<float(SurfacePoint&)> bend = {};
  OuterBoundary boundary = {};    ///< boundary of `media`; its fuzz holds light back
  MediaInside media_inside = {};  ///< heterogeneous medium, with `media` about its mean. Empty: homogeneous
  std::vector<std::array<HomogeneousMedium, 3>> layers =
      {};  ///< all media of `media_inside` if it has layers
};

/// Walks per sample, channel and light: default, and maximum with until_error.
inline constexpr std::size_t kDefaultWalks = 64, kMostWalks = 65536;

/// Sums over the walks of one channel, pass by pass.
struct WalkSums {
  std::size_t passes = 0;
  std::vector<float> flux;   ///< per sample: outgoing flux of its cell, in areas of a start
  std::vector<float> roots;  ///< roots of the sums over passes of its square
  double entered = 0;        ///< transmitted flux of the lights
  double lost = 0;           ///< fraction lost through holes of the mesh
  double stopped = 0;        ///< fraction absorbed by other meshes inside the body
};

/// Sums of one light at unit emission, or of all lights together.
struct SourceSums {
  std::array<WalkSums, 3> channels;
};

/// State to resume from, also with other colours of the lights.
struct VolumeSums {
  std::vector<SourceSums> sources;
};

/// A pass of one source and channel.
struct WalkPass {
  std::size_t source = 0, channel = 0, pass = 0;
};

/// Result of a pass. Passes added in their order give the bits of the sums of walk_volume.
struct PassSums {
  std::vector<double> flux;  ///< per sample, as WalkSums::flux
  /// Per range of starts: entered, lost and stopped, as in WalkSums.
  std::vector<std::array<double, 3>> totals;
};

struct VolumeExitance {
  std::vector<RgbF>
      exitance;             ///< one per sample: radiant exitance, W/mm^2, the mean over its cell's outer part
  std::vector<RgbF> error;  ///< one per sample: standard error of the exitance
  std::size_t walks = 0;    ///< per sample, in the channel and light with the most
  double relative_error =
      0;                  ///< rms over the surface of error over sqrt(exitance^2 + (1 % of the largest)^2)
  Rgb lost{}, stopped{};  ///< fractions of the transmitted light: see WalkSums
  /// See outer_shares(): empty unless parts of the body overlap or touch, or its surface crosses itself.
  std::vector<float> outer_shares = {};
};

/// True if a cell of this outer share is too small a part of the solid's boundary for its own exitance.
inline bool is_mostly_inside(float outer_share) {
  return outer_share < .1f;
}

/// True if each light has its own walks, independent of its colour; only with few lights.
bool walks_by_light(const VolumeInput& input);

/// Continues `sums` (empty: from the beginning) up to kDefaultWalks or the requested error. `sums` consist of
/// whole passes, also if the monitor interrupts. They depend on the input and the number of passes alone, not
/// on interruptions or threads; with sums by light (above) not on the lights' emission. With until_error,
/// passes are distributed over lights and channels by error.
/// in    after_pass: called between passes
/// error Error{interrupted}
void walk_volume(const VolumeInput& input, VolumeSums& sums,
                 const std::function<void(const VolumeSums&)>& after_pass = {});

/// Passes of each source and channel without until_error.
std::size_t default_passes();

/// Walks some of the passes of an image without until_error: those numbered from `first` to `last` - 1 and not
/// known. Reports each.
/// error Error{interrupted}
void walk_passes(const VolumeInput& input, std::size_t first, std::size_t last,
                 const std::function<bool(const WalkPass&)>& is_known,
                 const std::function<void(const WalkPass&, PassSums)>& keep);

void add_pass(WalkSums& sums, const PassSums& pass);

/// Exitance from the sums, with the colours of the lights.
VolumeExitance exitance_of(const VolumeInput& input, const VolumeSums& sums);

/// Volumetric path tracing from the lights: light enters the body, refracted by the geometric normal, and
/// random-walks until it is absorbed or leaves, where the cell of the nearest sample on its sheet collects
/// it. Unbiased for the mean over each cell. The same bits for any number of threads.
/// error Error{interrupted}
VolumeExitance volume_exitance(const VolumeInput& input);

}  // namespace opaline
