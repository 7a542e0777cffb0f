// SPDX-License-Identifier: GPL-3.0-or-later
// From a plan to trees of entered flux, one a group: all of a translucent picture that does not depend on the
// camera.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "opaline/core/monitor.h"
#include "opaline/core/stopwatch.h"
#include "opaline/diffusion/diffuse_profile.h"
#include "opaline/exitance/evaluate.h"
#include "opaline/exitance/surface_cache.h"
#include "opaline/irradiance/irradiance.h"
#include "opaline/octree/octree.h"
#include "opaline/render/plan.h"
#include "opaline/sampling/sample_surface.h"
#include "opaline/volume/cell_fit.h"
#include "opaline/volume/volume_diffusion.h"
#include "opaline/volume/volume_exitance.h"

namespace opaline {

struct HeldView;

/// Translucent shapes that share samples and one tree, and what has been computed of them.
struct Body {
  GroupPlan plan;
  DiffuseProfile profile;
  SurfaceSamples surface;
  std::vector<LightTransfer> transfers;  ///< one a light
  std::vector<RgbF> irradiance;          ///< one a sample, all lights
  Octree octree;
  SplitKernel kernel = {};
  SplitKernel wider_kernel = {};                   ///< CloudErrorInput::wider
  CloudError cloud = {};                           ///< of the samples with this irradiance and kernel
  std::optional<SurfaceCache> surface_cache = {};  ///< the exitance everywhere, where that is cheaper than at
                                                   ///< the points of the picture
  VolumeSums walks = {};                           ///< of Method::volume
  std::optional<VolumeExitance> volume = {};       ///< what they amount to, or volume_diffusion
  std::optional<VolumeExitance> bounced = {};  ///< what light from other surfaces adds to volume_diffusion
  std::shared_ptr<const CellFit> volume_fit = {};  ///< of both, at any point
  std::vector<RgbF> entering = {};                 ///< entering_tints, one a sample; empty: none
};

struct PrecomputeInput {
  const Scene& scene;
  const World& world;
  const RayScene& rays;
  const Plan& plan;
  Monitor* monitor = nullptr;
};

// What Session::prepare computes for each body, stage by stage; `group` is an index into the plan's groups,
// which chooses random numbers.

std::uint64_t sampling_seed(const Settings& settings, std::size_t group);
/// cells: unless null, of the samples.
SurfaceSamples place_samples(const PrecomputeInput& input, std::size_t group, SurfaceCells* cells = nullptr);

std::uint64_t irradiance_seed(const Settings& settings, std::size_t group);
/// Of irradiance_at at the points of a picture and the places of a surface cache.
std::uint64_t point_irradiance_seed(const Settings& settings);
/// in    lights: recentred, any of the scene's
std::vector<LightTransfer> light_samples(const PrecomputeInput& input, std::size_t group,
                                         std::span<const SurfaceSample> samples,
                                         std::span<const Light> lights);
/// The scene's lights in the world's space and unit; where they are many, trees of them (ManyLights).
std::vector<Light> recentred_lights(const Scene& scene, const World& world);

/// One minus the albedo of R G B, by reduced coefficients.
Rgb reduced_absorption(Medium medium);

/// For random walks inside a body with its samples. Media are walked with their mean cosine g (at most .95: to what is
/// nearer to 1 walks of the same reduced coefficients come close) and sigma_s = sigma_s' / (1 - g). Mean free paths
/// that rays cannot resolve, below about 1e-4 of the body, are taken longer: on such a body's scale light leaves where
/// it enters either way.
/// in    lights: recentred; they and the body outlive the result
VolumeInput walk_input(const PrecomputeInput& input, const Body& body, std::span<const Light> lights);

/// A body's surface where the cells of its plan cut it.
CutSurface cut_surface(const PrecomputeInput& input, const Body& body);
/// Those cells, for the diffusion equation inside of it; media as for walks.
/// in    body: with the samples of its cut surface
///       normals: of that
VolumeDiffusion diffusion_of(const PrecomputeInput& input, const Body& body, std::span<const Vec3f> normals);

/// Irradiance at each body's samples from surfaces, translucent ones as their trees have it and opaque ones as lights
/// alone light them; one list a body. view: where HeldView::at_samples are of the same samples, added to; or null
std::vector<std::vector<RgbF>> bounced_at_samples(const PrecomputeInput& input, std::span<const Body> bodies,
                                                  HeldView* view = nullptr);

/// The light that enters at a body's samples, tinted.
/// in    lights: those of its transfers
std::vector<RgbF> entered_irradiance(const Body& body, std::span<const Light> lights);

/// irradiance: one a sample.
Octree gather_flux(std::span<const SurfaceSample> samples, std::span<const RgbF> irradiance);
/// Laboratory::near_irradiance, but the samples' where all light comes from all around: rays at each point are as noisy as
/// those at the samples, and there are no sharp shadows to find (bunny-marble under `environment`, 256 x 256: mean
/// difference from 2048 rays a point .9 % in .06 s of shading, traced .7 % in 1.2 s).
NearIrradiance near_irradiance(const Scene& scene);
/// The kernel of a body, split at a distance that its samples' spacing, mm, decides.
SplitKernel group_kernel(const DiffuseProfile& profile, double spacing, const World& world,
                         const Scene& scene);

/// Of a group with its transfers, tree and kernels.
CloudError cloud_error(const Body& group, const World& world, const Scene& scene);

/// Radiant exitance at points of a group's surface, for callers with points of their own. Where the mean free
/// path is below the sample spacing, `render` traces shadow rays for the irradiance at its points; this
/// interpolates it.
/// in    points: world space, mm; normals: unit, outward, one a point
/// out   M_o in W/mm^2
/// per point, in their order
std::vector<RgbF> radiant_exitance(const Body& group, const World& world, std::span<const Vec3d> points,
                                   std::span<const Vec3f> normals, const Settings& settings);

/// Writes all samples as a binary PLY: x y z, nx ny nz, area, irradiance r g b, shape; world space, mm.
/// error Error{run_failed} naming the file
void write_samples_ply(const std::string& path, std::span<const Body> groups, const World& world);

}  // namespace opaline
