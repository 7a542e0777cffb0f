// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of translucent bodies and their transmitted light: independent of the camera.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "bodies/plan.h"
#include "core/stopwatch.h"
#include "diffusion/diffuse_profile.h"
#include "irradiance/irradiance.h"
#include "opaline/monitor.h"
#include "sampling/sample_surface.h"
#include "volume/cut_outer_surface.h"

namespace opaline {

struct HeldView;

/// Result of a method for a body; its type is in the method's folder (methods/).
struct MethodState {
  virtual ~MethodState() = default;
};

/// Translucent shapes sharing samples.
struct Body {
  BodyPlan plan;
  DiffuseProfile profile;
  OuterBoundary boundary;
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

/// cells: unless null, of the samples.
SurfaceSamples place_samples(const PrecomputeInput& input, std::size_t group, SurfaceCells* cells = nullptr);

/// Seed of irradiance_at at shading points and at the points of a surface cache.
std::uint64_t point_irradiance_seed(const Settings& settings);
/// in    lights: recentred, any of the scene's
std::vector<LightTransfer> trace_transfers(const PrecomputeInput& input, std::size_t group,
                                           const OuterBoundary& boundary,
                                           std::span<const SurfaceSample> samples,
                                           std::span<const Light> lights);
/// A light of the scene in the world's space and unit; that of a shape with its surface.
Light light_in_world(const Scene& scene, const World& world, const Light& light);
/// The scene's lights in the world's space and unit, with trees (ManyLights) for many lights.
std::vector<Light> recentred_lights(const Scene& scene, const World& world);

/// 1 - albedo of R G B, from reduced coefficients.
Rgb reduced_absorption(Medium medium);

/// A body's surface cut by the cells of its plan.
CutSurface body_cut_surface(const PrecomputeInput& input, const Body& body);
/// The light transmitted at a body's samples, tinted.
/// in    lights: those of its transfers
std::vector<RgbF> entered_irradiance(const Body& body, std::span<const Light> lights);

}  // namespace opaline
