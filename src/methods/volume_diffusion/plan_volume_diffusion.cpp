// SPDX-License-Identifier: GPL-3.0-or-later
// Cells, memory, time and stages of `volume_diffusion`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <variant>

#include "diffusion/diffuse_profile.h"
#include "methods/volume_diffusion/volume_diffusion_method.h"
#include "scene/scene_properties.h"
#include "subsurface/light_distance.h"
#include "subsurface/plan_samples.h"
#include "volume/volume_diffusion.h"

namespace opaline {
namespace {

bool varies(const Scene& scene, const BodyPlan& body) {
  return varies_inside(scene.media[body.medium]);
}

/// Why cells do not suit a body; empty: they do.
std::string reason_against_cells(const Scene& scene, const World& world, const BodyPlan& body) {
  if (!(body.smallest_mean_free_path > 0))
    return "the medium has no mean free path, so the body reflects diffusely";
  std::size_t open_edges = 0;
  for (const std::uint32_t mesh : body.meshes) open_edges += world.reports[mesh].open_edges;
  if (open_edges > 0)
    return fmt::format("its mesh is open ({} boundary edges) and encloses no volume", open_edges);
  constexpr double kThinnest = 1e-9;  // mean free paths; conductances of thinner bodies overflow
  if (body.thickness < kThinnest * body.smallest_mean_free_path) return "light crosses it without scattering";
  constexpr double kLeastOffsets = 64;  // distances of ray origins from the surface
  const Bounds box = bounds(world, body.meshes);
  if (body.thickness < kLeastOffsets * 0x1p-18 * length(box.high - box.low) * world.unit)
    return "it is too thin for rays to find its other side";
  if (!varies(scene, body) && is_too_large_for_cells(scene.settings, body))
    return fmt::format(
        "it requires more than {:.2g} million cells of {:.3g} mean free paths, and its surface is flat on "
        "that scale",
        kMostCells / 1e6, widest_cell(scene.settings));
  return {};
}

constexpr std::string_view kAsInReference = "as in the reference frame: ";

/// The body in the reference frame, or null.
const BodyPlan* reference_of(const PlanningInput& input, const BodyPlan& body) {
  const auto found = std::ranges::find_if(input.reference, [&](const BodyPlan& other) {
    return other.name == body.name && other.shared == body.shared;
  });
  return found == input.reference.end() ? nullptr : &*found;
}

/// Why the reference frame uses no cells; empty: it does, or there is none.
std::string reason_in_reference(const BodyPlan* reference) {
  if (reference == nullptr || reference->reason_against_method.empty()) return {};
  const std::string& reason = reference->reason_against_method;
  return reason.starts_with(kAsInReference) ? reason : std::string(kAsInReference) + reason;
}

/// Warns if closing the mesh would make cells applicable to the body.
void warn_of_open_mesh(const Scene& scene, const BodyPlan& body, std::vector<std::string>& warnings) {
  if (body.thickness > 0 || !(body.smallest_mean_free_path > 0)) return;
  const auto file_of = [&](std::uint32_t mesh) { return std::get_if<MeshFile>(&scene.shapes[mesh].source); };
  const bool is_built_in = std::ranges::none_of(body.meshes, file_of);
  const bool is_filled = std::ranges::all_of(body.meshes, [&](std::uint32_t mesh) {
    const MeshFile* const file = file_of(mesh);
    return file != nullptr && file->fill_holes.value_or(false);
  });
  warnings.push_back(body.name + ": " + body.reason_against_method +
                     "; uses hierarchical evaluation instead of volume_diffusion; " +
                     (is_built_in ? "use a closed shape, such as a slab"
                      : is_filled ? "close the holes that fill_holes cannot close"
                                  : "close the mesh (fill_holes)"));
}

/// Sum of a body's projections along the axes, over its area: 1 along the axes, 1.5 of a sphere.
double projected_fraction(const World& world, const BodyPlan& body) {
  double projected = 0, area = 0;
  for (const std::uint32_t m : body.meshes) {
    projected += world.measures[m].projected_area;
    area += world.measures[m].area;
  }
  return area > 0 ? projected / area : 1;
}

/// CPU seconds to trace the light transmitted at a sample from one direction.
double seconds_of_entry(const Medium& medium, const BodyPlan& body) {
  constexpr double kEntry = 8e-7;        // per direction of incident light at a sample
  constexpr double kEntryStep = 1.5e-7;  // per step of this light through cells
  constexpr double kStep = .4;           // cells: BodyPaths::kStep
  constexpr double kMostSteps = 100;     // cells far inside are larger
  const DiffuseProfile profile = make_diffuse_profile(medium);
  const double amplitude = (profile.eta - 1) / (profile.eta + 1);
  const double crossings = 1 / (1 - std::min(.9, amplitude * amplitude));  // reflected inside
  const double path = std::min(max_component(profile.mean_free_path), crossings * body.thickness);
  return kEntry + kEntryStep * std::min(kMostSteps, path / (kStep * body.cell));
}

}  // namespace

void VolumeDiffusionMethod::plan(const PlanningInput& input, BodyPlan& body,
                                 std::vector<std::string>& warnings) const {
  const BodyPlan* const reference = reference_of(input, body);
  body.reason_against_method = reason_against_cells(input.scene, input.world, body);
  if (!body.reason_against_method.empty()) {
    warn_of_open_mesh(input.scene, body, warnings);
    if (reference != nullptr && reference->method == Method::volume_diffusion)
      warnings.push_back(body.name +
                         ": uses volume_diffusion in the reference frame, so the frames look different");
  } else {
    body.reason_against_method = reason_in_reference(reference);
  }
  if (!body.reason_against_method.empty()) {
    body.method = Method::hierarchical;
    return method_of(body.method).plan(input, body, warnings);
  }
  choose_cells(input.scene, input.world, input.fewest_samples, body, warnings);
  choose_cut(input.scene.settings, input.fewest_samples, body, warnings);
  warn_of_near_lights(input.scene, input.world, body, warnings);
}

BodyMemory VolumeDiffusionMethod::memory(const PlanningInput& input, const BodyPlan& body) const {
  // Bytes, fitted to bench_plan: per cell cutting the surface, exitance and error during the fits; per light,
  // weights; with bounces, the gathered light, and the exitance on its rays.
  constexpr std::size_t kCutSample = 680, kLight = 4, kBounces = 250;
  constexpr double kVaryingCell = 500;  // its own medium, and the flux to each neighbour
  const double in_wires =
      body.thickness > 0 ? 1.2 * needle_fraction(input.world, body) * body.cell / body.thickness : 0;
  // The cells cutting a surface are as many as those of its projections along the axes; fitted to spheres.
  constexpr double kProjectedOfSphere = 1.5;
  const double of_sphere = projected_fraction(input.world, body) / kProjectedOfSphere;
  // Thin bodies have most cells between their sides.
  constexpr double kThin = 4;
  const bool is_thin = body.thickness > 0 && body.thickness < kThin * body.cell;
  BodyMemory memory;
  memory.kept +=
      std::size_t(std::max(is_thin ? 1 : of_sphere, in_wires) * double(body.samples)) *
      (kCutSample + kLight * input.lights.size() + (gathers_light(input.scene, body) ? kBounces : 0));
  memory.kept +=
      std::size_t((kBytesOfCell + (varies(input.scene, body) ? kVaryingCell : 0)) *
                  expected_cells(body.area, body.thickness, body.cell) * (is_thin ? 1 : of_sphere));
  return memory;
}

double VolumeDiffusionMethod::seconds(const Scene& scene, const BodyPlan& body,
                                      const Lighting& lighting) const {
  constexpr double kCutSample = 8e-6;                             // cut, and its fit
  constexpr double kCell = 4e-6;                                  // made and solved, three channels
  constexpr double kVaryingCell = 1e-5;                           // its own medium
  const double solutions = gathers_light(scene, body) ? 1.5 : 1;  // on coarser cells
  const double cell = kCell * solutions + (varies(scene, body) ? kVaryingCell : 0);
  return expected_cells(body.area, body.thickness, body.cell) * cell +
         double(body.samples) *
             (kCutSample + kSecondsOfShadowRay * lighting.rays +
              solutions * lighting.directions * seconds_of_entry(scene.media[body.medium], body));
}

std::string VolumeDiffusionMethod::body_stage(const BodyPlan& body) const {
  return fmt::format(
      "{} by volume_diffusion: about {:.2g} cells, {:.3g} mm at the surface ({:.3g} mean free paths)",
      body.name, expected_cells(body.area, body.thickness, body.cell), body.cell,
      body.cell / body.smallest_mean_free_path);
}

}  // namespace opaline
