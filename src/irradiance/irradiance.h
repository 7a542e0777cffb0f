// SPDX-License-Identifier: GPL-3.0-or-later
// Transmitted irradiance at surface samples, by light.
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
#include "transport/outer_boundary.h"

namespace opaline {

struct IrradianceInput {
  const RayScene& rays;
  std::span<const SurfaceSample> samples;
  std::span<const Light> lights;  ///< in the world's recentred space
  OuterBoundary boundary = 1;
  int light_samples = 64;  ///< shadow rays a sample for lights with an area
  std::uint64_t seed = 0;
  Monitor* monitor = nullptr;
  /// Uses the triangles' normals for cosines and Ft, conserving the incident flux. Interpolated normals
  /// change it where the surface bends within few triangles.
  bool geometric_normals = false;
  /// Turns the normal of a point by the maps of its surface, averaged over its width, and returns a factor of the light
  /// entering. Empty: no maps.
  std::function<float(SurfacePoint&)> bend = {};
};

/// E(x) = integral of L_i Ft(omega_i) cos d omega is linear in each light's colour, and Ft is equal for all
/// channels: one number per sample and light suffices, and a change of colour traces no ray.
struct LightTransfer {
  /// E per unit emission at each sample, >= 0; beside an edge of this light's shadow, the mean over its
  /// Voronoi cell (with twice the rays for an area light, not included in relative_error).
  std::vector<float> weights;
  /// RMS over the samples of the estimated standard error, over the mean; 0 for delta lights (is_delta), and
  /// for a single light sample, without an estimate.
  double relative_error = 0;
  /// Relative bias of this light's total (area x weight, summed over the samples) from replacing weights
  /// beside shadow edges by means over cells. With few rays per sample, noise also selects samples for
  /// replacement, and the total becomes biased. Excludes changes within their own noise, and changes not
  /// explained by the noise of rays.
  double edge_shift = 0;
};

/// One transfer per light. Cosines and Ft use the shading normal unless requested otherwise; tests of the
/// light's side use the geometric one. Everything in the scene is opaque to shadow rays.
std::vector<LightTransfer> compute_irradiance(const IrradianceInput& input);

/// E per sample, W/mm^2, per unit area of the surface: the sum over lights of emission x weight.
std::vector<RgbF> combine_lights(std::span<const LightTransfer> transfers, std::span<const Light> lights);

struct PointIrradianceInput {
  const RayScene& rays;
  std::span<const SurfacePoint> points;
  std::span<const std::uint64_t> keys;  ///< one per point: its position in the low-discrepancy sequence
  std::span<const Light> lights;        ///< recentred
  OuterBoundary boundary = {};
  int light_samples = 64;
  std::uint64_t seed = 0;
  /// Unless empty: one per point, receives the estimated variance of its irradiance, per channel, in double:
  /// the square of a brightness exceeds float's range.
  std::span<Rgb> variance = {};
  /// Unless empty: irradiance from other surfaces, one per point. Already included elsewhere: irradiance_at
  /// does not add it.
  std::span<const RgbF> bounced = {};
  /// True for coherent points: neighbours share the visibility of an environment.
  bool is_together = false;
  /// Unless empty: one per point, the irradiance by the same rays without any shadow is added to it.
  std::span<RgbF> unshadowed = {};
  /// As IrradianceInput::bend, for further points on the surface of the body; the normals of `points` are final.
  std::function<float(SurfacePoint&)> bend = {};
};

/// Turns the normals of further points by input.bend; returns the factors of their light, none without maps.
/// in    points: with their widths
std::vector<float> bend_all(const PointIrradianceInput& input, std::span<SurfacePoint> points);

/// Irradiance at points from one light, per unit emission.
struct PointTransfers {
  /// E per unit emission at each point; >= 0, or for an environment with a mean >= 0 over the points of a
  /// pixel.
  std::vector<float> weights;
  std::vector<float> deviations;  ///< standard errors of the weights; empty: not requested
};

/// Shadow rays from each point to each of input.lights; deviations where input.variance is not empty.
std::vector<PointTransfers> transfers_at(const PointIrradianceInput& input);
/// The same for missing entries only: those without weights.
void add_transfers(const PointIrradianceInput& input, std::vector<PointTransfers>& transfers);

/// E per point, W/mm^2: the sum over lights of emission x weight; adds to input.variance unless empty.
/// in    transfers: one per light
std::vector<RgbF> combine_lights(std::span<const PointTransfers> transfers,
                                 const PointIrradianceInput& input);

/// Light reaching a point by one shadow ray: index of the light and of the point, unit direction towards the
/// light, irradiance per unit emission.
using UseOfRay =
    std::function<void(std::size_t light, std::size_t point, const Vec3f& towards_light, float irradiance)>;

/// Unblocked shadow rays of transfers_at, one by one: the mean of their sum at a point is its weight.
/// in    lobes: one per point, for reflected light; many delta lights (ManyLights) then get more samples,
///       mainly in the lobe. Empty: for the irradiance
void for_each_ray(const PointIrradianceInput& input, const UseOfRay& use, std::span<const Lobe> lobes = {});

/// Irradiance at arbitrary points, all lights together: for shading without samples, or with too coarse ones.
std::vector<RgbF> irradiance_at(const PointIrradianceInput& input);

}  // namespace opaline
