// SPDX-License-Identifier: GPL-3.0-or-later
// Entered irradiance at surface samples, kept per light.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"
#include "lights/light.h"
#include "opaline/monitor.h"
#include "opaline/scene.h"
#include "sampling/sample_surface.h"

namespace opaline {

struct IrradianceInput {
  const RayScene& rays;
  std::span<const SurfaceSample> samples;
  std::span<const Light> lights;  ///< in the world's recentred space
  double eta = 1;                 ///< inside / outside
  int light_samples = 64;         ///< shadow rays a sample for lights with an area
  std::uint64_t seed = 0;
  Monitor* monitor = nullptr;
  /// Cosines and Ft by the triangles' normals: what enters the mesh as it is. Interpolated ones gain and lose light where
  /// the surface turns within few triangles.
  bool geometric_normals = false;
};

/// E(x) = integral of L_i Ft(omega_i) cos d omega is linear in each light's colour, and Ft is the same for
/// all channels: one number a sample and light is enough, and recolouring a light traces no ray.
struct LightTransfer {
  /// One a sample: E per unit emission, >= 0, at the sample's point; beside the edge of this light's shadow
  /// the mean over its Voronoi cell (an area light then has twice the rays, and relative_error does not know
  /// of them).
  std::vector<float> weights;
  /// RMS over the samples of the estimated standard error, over the mean; 0 for delta lights (is_delta), and for a
  /// single light sample, which cannot tell.
  double relative_error = 0;
  /// Relative change of this light's total (area x weight, summed over the samples) that came from replacing
  /// weights beside shadow edges by means over cells. With few rays a sample, neighbours also differ by
  /// chance; samples are then chosen for replacement because of their noise, and the total becomes biased. Only
  /// that: no change within its own noise, nor one that the noise of rays does not explain.
  double edge_shift = 0;
};

/// One transfer per light. Cosines and Ft use the shading normal unless asked otherwise; which side a light is on, the
/// geometric one. Everything in the scene casts full shadows.
std::vector<LightTransfer> compute_irradiance(const IrradianceInput& input);

/// E per sample, W/mm^2, per unit area of the surface: the sum over lights of emission x weight.
std::vector<RgbF> combine_lights(std::span<const LightTransfer> transfers, std::span<const Light> lights);

struct PointIrradianceInput {
  const RayScene& rays;
  std::span<const SurfacePoint> points;
  std::span<const std::uint64_t> keys;  ///< one a point: chooses its place in the low-discrepancy points
  std::span<const Light> lights;        ///< recentred
  double eta = 0;                       ///< inside / outside; 0: no boundary, Ft = 1 (opaque surfaces)
  int light_samples = 64;
  std::uint64_t seed = 0;
  /// If not empty: one a point, to which the estimated variance of its irradiance is added, per channel.
  /// Double: the square of a brightness leaves a float's range.
  std::span<Rgb> variance = {};
  /// If not empty: one a point, what other surfaces send there. Known already: irradiance_at does not add it.
  std::span<const RgbF> bounced = {};
  /// True if points following each other lie together: what hides a room from some then tells of others.
  bool is_together = false;
};

/// Irradiance at points from one light, per unit emission.
struct PointTransfers {
  /// One a point: E per unit emission; >= 0, or of a room's light the mean over the points of a pixel is.
  std::vector<float> weights;
  std::vector<float> deviations;  ///< standard errors of the weights; empty: not asked for
};

/// Shadow rays from each point to each of input.lights; deviations where input.variance is not empty.
std::vector<PointTransfers> transfers_at(const PointIrradianceInput& input);
/// The same but for those that are there already: with weights, or without points.
void add_transfers(const PointIrradianceInput& input, std::vector<PointTransfers>& transfers);

/// E per point, W/mm^2: the sum over lights of emission x weight; adds to input.variance if it is not empty.
/// in    transfers: one a light
std::vector<RgbF> combine_lights(std::span<const PointTransfers> transfers,
                                 const PointIrradianceInput& input);

/// Light reaching a point by one shadow ray: index of the light and of the point, unit direction towards the light,
/// irradiance per unit emission.
using UseOfRay =
    std::function<void(std::size_t light, std::size_t point, const Vec3f& towards_light, float irradiance)>;

/// The shadow rays of transfers_at that reach lights, one by one: the mean of their sum at a point is its weight.
/// in    lobes: one a point, which light is wanted for; of many delta lights (ManyLights) more are then drawn, rather
///       those in the lobe. Empty: for the irradiance
void for_each_ray(const PointIrradianceInput& input, const UseOfRay& use, std::span<const Lobe> lobes = {});

/// Irradiance at arbitrary points, all lights together: for shading where samples are not wanted or too
/// coarse.
std::vector<RgbF> irradiance_at(const PointIrradianceInput& input);

}  // namespace opaline
