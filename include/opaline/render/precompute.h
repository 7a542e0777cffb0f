// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of translucent bodies and their transmitted light: independent of the camera.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "opaline/core/monitor.h"
#include "opaline/core/stopwatch.h"
#include "opaline/diffusion/diffuse_profile.h"
#include "opaline/irradiance/irradiance.h"
#include "opaline/render/plan.h"
#include "opaline/sampling/sample_surface.h"
#include "opaline/volume/cut_outer_surface.h"

namespace opaline {

struct HeldView;

/// Result of a method for a body, opaque to all other code (methods/).
struct MethodState {
  virtual ~MethodState() = default;
};

/// Translucent shapes sharing samples.
struct Body {
  GroupPlan plan;
  DiffuseProfile profile;
  SurfaceSamples surface;
  std::vector<LightTransfer> transfers;  ///< one per light
  std::vector<RgbF> entering = {};       ///< entering_tints, one per sample; empty: none
  std::map<Method, std::unique_ptr<MethodState>> states = {};
};

struct PrecomputeInput {
  const Scene& scene;
  const World& world;
  const RayScene& rays;
  const Plan& plan;
  Monitor* monitor = nullptr;
};

// Stages shared by methods; `group` is an index into the plan's bodies, and selects random numbers.

std::uint64_t sampling_seed(const Settings& settings, std::size_t group);
/// cells: unless null, of the samples.
SurfaceSamples place_samples(const PrecomputeInput& input, std::size_t group, SurfaceCells* cells = nullptr);

std::uint64_t irradiance_seed(const Settings& settings, std::size_t group);
/// Seed of irradiance_at at shading points and at the points of a surface cache.
std::uint64_t point_irradiance_seed(const Settings& settings);
/// in    lights: recentred, any of the scene's
std::vector<LightTransfer> light_samples(const PrecomputeInput& input, std::size_t group,
                                         std::span<const SurfaceSample> samples,
                                         std::span<const Light> lights);
/// The scene's lights in the world's space and unit, with trees (ManyLights) for many lights.
std::vector<Light> recentred_lights(const Scene& scene, const World& world);

/// 1 - albedo of R G B, from reduced coefficients.
Rgb reduced_absorption(Medium medium);

/// A body's surface cut by the cells of its plan.
CutSurface cut_surface(const PrecomputeInput& input, const Body& body);
/// Irradiance at each body's samples from surfaces: translucent ones from their trees, opaque ones under
/// direct light; one list per body. view: cache with HeldView::at_samples for the same samples, extended; or
/// null
std::vector<std::vector<RgbF>> bounced_at_samples(const PrecomputeInput& input, std::span<const Body> bodies,
                                                  HeldView* view = nullptr);

/// The light transmitted at a body's samples, tinted.
/// in    lights: those of its transfers
std::vector<RgbF> entered_irradiance(const Body& body, std::span<const Light> lights);

/// Radiant exitance at arbitrary points of a body's surface. For mean free paths below the sample spacing,
/// `render` traces shadow rays for the irradiance at its points; this function interpolates it.
/// in    body: prepared; points: world space, mm; normals: unit, outward, one per point
/// out   M_o in W/mm^2, one per point
std::vector<RgbF> radiant_exitance(const Body& body, const World& world, std::span<const Vec3d> points,
                                   std::span<const Vec3f> normals, const Settings& settings);

/// Writes all samples as a binary PLY: x y z, nx ny nz, area, irradiance r g b, shape; world space, mm.
/// error Error{run_failed} naming the file
void write_samples_ply(const std::string& path, std::span<const Body> groups, const World& world);

}  // namespace opaline
