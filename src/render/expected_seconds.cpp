// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/render/expected_seconds.h"

#include <algorithm>

#include "opaline/lights/light.h"
#include "opaline/render/direct.h"
#include "opaline/volume/volume_diffusion.h"
#include "opaline/volume/volume_exitance.h"

namespace opaline {
namespace {

// CPU seconds, fitted to what bench_plan prints.
constexpr double kTriangle = 1e-6;  // read, mended, in the rays' tree
constexpr double kShadowRay = 1e-7;
constexpr double kSample = 8e-6;         // placed, in the tree
constexpr double kGather = 6e-5;         // light from other bodies at a sample
constexpr double kGatherAlone = 1e-5;    // the same where there is one body
constexpr double kCutSample = 8e-6;      // cut, and its fit
constexpr double kCell = 4e-6;           // made and solved, three channels
constexpr double kOfVaryingCell = 1e-5;  // its own medium
constexpr double kEntry = 2e-7;          // a direction from which light enters at a sample
constexpr double kEntryCell = 9e-8;      // a cell that this light crosses
constexpr double kWalk = 1e-5;
constexpr double kPixel = 5e-7;        // a camera ray, shaded
constexpr double kEntrySample = 1e-7;  // of `direct`, beside its shadow rays
constexpr double kSmallestWalks = 32;  // a sample, before an error is estimated

struct Lighting {
  double rays = 0;  // shadow rays from a point
  double lights = 0;
  double directions = 0;  // from which light enters at a sample of volume_diffusion
};

Lighting lighting_of(const Scene& scene) {
  Lighting all;
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    if (l > 0 && share_rays(scene.lights[l - 1], scene.lights[l])) continue;
    all.rays += shadow_rays(scene.lights[l], scene.settings.light_samples);
    all.lights += 1;
    all.directions += is_delta(scene.lights[l]) ? 1 : 8;
  }
  return all;
}

/// CPU seconds to trace the light transmitted at a sample from one direction.
double seconds_of_entry(const Medium& medium, const GroupPlan& group) {
  constexpr double kMostCells = 50;  // cells far inside are larger
  const double longest = max_component(make_diffuse_profile(medium).mean_free_path);
  return kEntry + kEntryCell * std::min(kMostCells, std::min(longest, group.thickness) / group.cell);
}

double seconds_of_body(const Scene& scene, const GroupPlan& group, const Lighting& lighting) {
  const double gather = bounces_of(scene) == 0 ? 0 : scene.shapes.size() > 1 ? kGather : kGatherAlone;
  const auto samples = double(group.samples);
  const double solutions = bounces_of(scene) > 0 ? 2 : 1;
  switch (group.method) {
    case Method::hierarchical:
      return samples * (kSample + kShadowRay * lighting.rays + gather);
    case Method::volume_diffusion: {
      const double cell =
          kCell * solutions + (varies_inside(scene.media[group.medium], group.method) ? kOfVaryingCell : 0);
      return expected_cells(group.area, group.thickness, group.cell) * cell +
             samples * (kCutSample + kShadowRay * lighting.rays +
                        solutions * lighting.directions * seconds_of_entry(scene.media[group.medium], group));
    }
    case Method::volume:
      return samples * kWalk * 3 * std::clamp(lighting.lights, 1., 4.) *
             (scene.settings.until_error ? kSmallestWalks : double(kDefaultWalks));
    default:
      return 0;
  }
}

double seconds_of_shading(const Scene& scene, const Lighting& lighting) {
  const Film& film = scene.film;
  const double pixels = double(film.resolution[0]) * double(film.resolution[1]);
  double seconds = pixels * double(film.samples_per_pixel) * (kPixel + kShadowRay * lighting.lights);
  if (scene.settings.method == Method::lambert) seconds += pixels * kShadowRay * lighting.rays;
  if (scene.settings.method == Method::direct)
    seconds += pixels * double(scene.settings.entry_samples.value_or(kDefaultEntrySamples)) *
               (kEntrySample + kShadowRay * lighting.lights);
  return seconds;
}

}  // namespace

double expected_seconds(const Scene& scene, const Plan& plan) {
  const Lighting lighting = lighting_of(scene);
  double seconds = kTriangle * double(plan.triangles) + seconds_of_shading(scene, lighting);
  for (const GroupPlan& group : plan.groups) seconds += seconds_of_body(scene, group, lighting);
  return seconds;
}

}  // namespace opaline
