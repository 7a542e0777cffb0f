// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance of a body from the diffusion equation inside it: fast, and independent of a kernel's assumptions.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "geometry/world.h"
#include "irradiance/irradiance.h"
#include "opaline/monitor.h"
#include "transport/medium.h"
#include "volume/cut_surface.h"
#include "volume/media_inside.h"
#include "volume/volume_exitance.h"

namespace opaline {

struct VolumeDiffusionInput {
  const World& world;
  std::span<const std::uint32_t> meshes;   ///< meshes of the body
  std::span<const SurfaceSample> samples;  ///< samples of its cut_surface with these cells
  std::span<const Vec3f> normals;          ///< normals of the same cut_surface
  std::array<HomogeneousMedium, 3> media;  ///< R G B, isotropic, in the world's unit of length
  double cell = 1;                         ///< edge of the cells at the surface, world units
  MediaInside media_inside = {};           ///< isotropic; replaces `media`. Empty: homogeneous
  bool is_calibrated = false;              ///< media_inside: with the boundary of `media`, as of layers
};

/// Minimum length to resolve, over the diffuse mean free path; src/volume/README.md.
inline constexpr double kPerFading = .45;
/// Length resolved by cells: the mean free path, or kPerFading times the diffuse mean free path if that is
/// shorter.
/// in    mean_free_path: 1/sigma_t', of any unit; absorbed: 1 - albedo'
double length_to_resolve(double mean_free_path, double absorbed);
/// Widest cell over the length to resolve. Shorter mean free paths are lengthened to match, with the same
/// albedo.
inline constexpr double kWidestCell = 3;

/// Approximate number of cells of a body.
/// in    area, thickness (twice the volume over the area; 0: unknown), cell: edge at the surface; in one unit
///       of length
double expected_cells(double area, double thickness, double cell);
/// Bytes per cell, both grids and the solver's vectors included; bench_plan.
inline constexpr double kBytesOfCell = 320;

/// Diffusion from the first collisions along the refracted rays, on cells growing inwards. Linear in the
/// lights; the cells do not depend on them. Theory and measurements: src/volume/README.md.
class VolumeDiffusion {
 public:
  explicit VolumeDiffusion(const VolumeDiffusionInput& input);
  VolumeDiffusion(VolumeDiffusion&&) noexcept;
  ~VolumeDiffusion();

  /// in    lights: recentred; transfers: one per light, to the samples; tints: factors on the transmitted
  ///       light, one per sample, or empty
  /// out   exitance and error, one per sample. The error is the discretization error, from cells of twice the
  ///       size, without that of diffusion itself. walks, relative_error, lost: 0. The same bits for any
  ///       number of threads
  /// error Error{interrupted}
  VolumeExitance exitance(std::span<const Light> lights, std::span<const LightTransfer> transfers,
                          std::span<const RgbF> tints = {}, Monitor* monitor = nullptr) const;

  /// Exitance for uniform incident light at each sample, the approximation for light from other surfaces.
  /// Uses cells of twice the size, as this light is smooth and a small part of all.
  /// in    entering: transmitted irradiance, W per area, one per sample; beside: exitance by other light, one per
  ///       sample, or empty; the more there is, the noisier is the result
  /// out   error: 0, as that of cells for other light does not apply
  VolumeExitance exitance_of_even(std::span<const RgbF> entering, std::span<const RgbF> beside = {},
                                  Monitor* monitor = nullptr) const;

  /// Cells of the finer grid.
  std::size_t cells() const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace opaline
