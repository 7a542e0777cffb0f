// SPDX-License-Identifier: GPL-3.0-or-later
#include "subsurface/plan_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "assets/import_asset.h"
#include "bodies/local_media.h"
#include "bodies/plan_texts.h"
#include "core/units.h"
#include "diffusion/diffuse_profile.h"
#include "scene/scene_properties.h"
#include "volume/volume_diffusion.h"

namespace opaline {
namespace {

// Lower bounds resolving the irradiance itself, however far light travels inside. With many bodies, each is
// small in the image, and all share kFewestOfAll.
constexpr double kFewestSamples = 10000, kFewestOfAll = 2e6, kFewestOfMany = 100;
constexpr double kSuspiciouslyFew = 100;
constexpr const char* kTheMinimum = "the minimum";

// Largest sample spacing: 1.5 mean free paths, or the diffuse mean free path if that is shorter, but at least
// one mean free path. SplitKernel takes transport below the spacing from the irradiance at the shading point
// itself. Where diffuse light decays faster, the exitance in shadow depends on the exact sample positions, so
// the spacing follows the decay.
double widest_spacing(const Medium& medium) {
  const DiffuseProfile profile = make_diffuse_profile(medium);
  const double path = medium.shortest_path, fading = medium.shortest_fading;
  double widest = path > 0 ? std::clamp(fading > 0 ? fading : path, path, 1.5 * path) : INFINITY;
  for (std::size_t c = 0; c < 3; ++c) {
    const double length = profile.mean_free_path[c];
    if (profile.total[c] > 0 && length > 0)
      widest = std::min(widest, std::clamp(profile.diffuse_mean_free_path[c], length, 1.5 * length));
  }
  return widest;
}

void warn_of_few_samples(const BodyPlan& group, double wanted, std::vector<std::string>& warnings) {
  if (wanted < kSuspiciouslyFew)
    warnings.push_back(fmt::format(
        "{}: light crosses the whole object, with a mean free path of {:.4g} mm and an area of {:.4g} "
        "mm^2; check mm_per_unit",
        group.name, group.smallest_mean_free_path, group.area));
}

/// Number of samples from the settings, if set.
std::optional<double> set_samples(const Settings& settings, double area) {
  if (settings.samples) return double(*settings.samples);
  if (settings.sample_spacing) return area / (*settings.sample_spacing * *settings.sample_spacing);
  return {};
}

/// Smallest diffuse mean free path of the scattering channels, mm.
double shortest_fading(Medium medium) {
  medium.profile = ProfileKind::dipole;  // classical D, as in the diffusion equation
  const DiffuseProfile profile = make_diffuse_profile(medium);
  double shortest = INFINITY;
  for (std::size_t c = 0; c < 3; ++c)
    if (profile.total[c] > 0 && !is_local(profile, c))
      shortest = std::min(shortest, profile.diffuse_mean_free_path[c]);
  return shortest;
}

}  // namespace

double fewest_samples(std::size_t bodies) {
  return std::clamp(kFewestOfAll / double(bodies), kFewestOfMany, kFewestSamples);
}

void choose_samples(const Scene& scene, double fewest, BodyPlan& group, std::vector<std::string>& warnings) {
  const Settings& settings = scene.settings;
  const double mean_free_path = group.smallest_mean_free_path,
               spacing = widest_spacing(scene.media[group.medium]);
  // Without a mean free path, light leaves where it enters, and no samples are necessary.
  const double wanted = std::isfinite(spacing) ? group.area / (spacing * spacing) : fewest;
  double count = set_samples(settings, group.area).value_or(std::max(wanted, fewest));
  if (settings.samples) {
    group.reason = "settings.samples";
  } else if (settings.sample_spacing) {
    group.reason = fmt::format("settings.sample_spacing of {:.4g} mm", *settings.sample_spacing);
  } else if (wanted <= fewest) {
    group.reason = kTheMinimum;
  } else {
    group.reason =
        fmt::format("{:.2f} mean free paths of {:.4g} mm", spacing / mean_free_path, mean_free_path);
  }
  if (count > double(settings.max_samples)) {
    const std::string required = count > 1e12 ? "more than a trillion" : fmt::format("{:.3g}", count);
    const bool is_asset = is_asset_name(scene.file);
    warnings.push_back(
        fmt::format("{}: requires {} samples ({}) but uses {} (settings.max_samples{}); check mm_per_unit{}: "
                    "the area is {:.4g} mm^2, the mean free path {:.4g} mm",
                    group.name, required, group.reason, settings.max_samples,
                    is_asset && settings.max_samples == kMostUnsizedSamples ? ", fewer without a size" : "",
                    is_asset ? ", or give a size such as --size 50mm" : "", group.area, mean_free_path));
    count = double(settings.max_samples);
    group.reason = "settings.max_samples";
  }
  warn_of_few_samples(group, wanted, warnings);
  group.samples = std::max<std::size_t>(1, std::size_t(std::ceil(count)));
  group.spacing = std::sqrt(group.area / double(group.samples));
}

std::string samples_text(const BodyPlan& group) {
  const std::string count = grouped(group.samples) + (group.samples == 1 ? " sample" : " samples");
  if (group.reason == kTheMinimum) return fmt::format("{} ({})", count, group.reason);
  return fmt::format("{}, spacing {:.4g} mm: {}", count, group.spacing, group.reason);
}

std::string mean_free_path_text(const Scene& scene, const BodyPlan& group) {
  if (!(group.smallest_mean_free_path > 0)) return "no mean free path (diffuse reflection)";
  const DiffuseProfile profile = make_diffuse_profile(scene.media[group.medium]);
  bool scatters = true;  // inside, in all channels
  for (std::size_t c = 0; c < 3; ++c) scatters &= profile.total[c] > 0 && profile.mean_free_path[c] > 0;
  return fmt::format("mean free path {:.4g} mm (smallest channel{})", group.smallest_mean_free_path,
                     scatters ? "" : " that scatters inside");
}

double widest_cell(const Settings& settings) {
  return std::max(kWidestCell, settings.cell_size);
}

bool is_too_large_for_cells(const Settings& settings, const BodyPlan& group) {
  const double widest = widest_cell(settings) * group.smallest_mean_free_path;
  return widest > 0 && expected_cells(group.area, 0, widest) > kMostCells;
}

bool is_too_thin_for_cells(const BodyPlan& group) {
  constexpr double kTooThin = .6;  // mean free paths; src/volume/README.md
  return group.thickness > 0 && group.thickness < kTooThin * group.smallest_mean_free_path;
}

namespace {

/// Cell size of volume_diffusion: as set, smaller to resolve the decay of light and thin bodies, or if the cells are
/// few.
/// in    fading: smallest diffuse mean free path, mm
double resolving_cell(const Scene& scene, const World& world, double fewest, const BodyPlan& group,
                      double fading) {
  constexpr double kAcrossThin = 2, kSmallest = .25;
  constexpr double kOfVarying = .5;    // a cell has one medium, and light blurs detail below a mean free path
  constexpr double kFewestFaces = 60;  // fewest faces of cells, on the surface
  constexpr double kEasyFaces = .4;    // per sample of `fewest`; if there are fewer, cells are smaller
  const Medium& medium = scene.media[group.medium];
  double cell =
      scene.settings.cell_size * (varies_inside(medium) && medium.layers.empty()
                                      ? kOfVarying * short_length_of(scene, world, group)
                                      : std::min(group.smallest_mean_free_path, kPerFading * fading));
  const double by_default = cell * Settings{}.cell_size / scene.settings.cell_size;
  cell *= std::clamp(std::sqrt(group.area / (kEasyFaces * fewest)) / by_default, .25, 1.);
  if (group.thickness > 0) cell = std::min(cell, std::max(group.thickness / kAcrossThin, kSmallest * cell));
  return std::min(cell, std::sqrt(group.area / kFewestFaces));
}

/// Smallest cell within the limits of cells and samples.
double smallest_cell(const Settings& settings, const BodyPlan& group) {
  const double most_faces =
      std::min(kMostCells / expected_cells(1, 0, 1), double(settings.max_samples) / kCutSamplesPerFace);
  return std::sqrt(group.area / most_faces);
}

}  // namespace

bool is_too_large_for_layers(const Scene& scene, const World& world, double fewest, const BodyPlan& group) {
  const Medium& medium = scene.media[group.medium];
  if (medium.layers.empty()) return false;
  double fading = shortest_fading(medium);
  if (medium.shortest_fading > 0)
    fading = std::min(fading, medium.shortest_fading);  // one method for all wavelengths
  return resolving_cell(scene, world, fewest, group, fading) < smallest_cell(scene.settings, group);
}

void choose_cells(const Scene& scene, const World& world, double fewest, BodyPlan& group,
                  std::vector<std::string>& warnings) {
  const double length = group.smallest_mean_free_path;
  const double fading = shortest_fading(scene.media[group.medium]);
  group.cell =
      std::max(resolving_cell(scene, world, fewest, group, fading), smallest_cell(scene.settings, group));
  if (group.cell > widest_cell(scene.settings) * length)
    warnings.push_back(fmt::format(
        "{}: light leaves within {:.3g} mm, but because of settings.max_samples the cells are {:.3g} mm wide",
        group.name, length, group.cell));
  if (is_too_thin_for_cells(group))
    warnings.push_back(
        fmt::format("{}: the mean thickness is {:.3g} mean free paths; diffusion cannot model light that "
                    "crosses a body almost without scattering; use --method volume",
                    group.name, group.thickness / length));
}

// Divides a cell's edge to come close to the requested samples, with at least one sample per cell cut by the
// surface.
void choose_cut(const Settings& settings, double fewest, BodyPlan& group,
                std::vector<std::string>& warnings) {
  const double whole = kCutSamplesPerFace * group.area / (group.cell * group.cell);
  const double wanted = set_samples(settings, group.area).value_or(fewest);
  double parts = std::min(std::round(std::sqrt(wanted / whole)),
                          std::floor(std::sqrt(double(settings.max_samples) / whole)));
  // The cells along a wire thinner than a cell depend on its length, not its area: finer ones would be many
  // and of no use.
  constexpr double kPartsOfThickness = 8;
  if (group.thickness > 0) parts = std::min(parts, kPartsOfThickness * group.thickness / group.cell);
  group.cell_parts = int(std::max(1., parts));
  group.samples =
      std::max<std::size_t>(1, std::size_t(std::ceil(whole * group.cell_parts * group.cell_parts)));
  group.spacing = std::sqrt(group.area / double(group.samples));
  group.reason = fmt::format("one per surface cell of {:.4g} mm", group.cell / double(group.cell_parts));
  const double length = group.smallest_mean_free_path;
  warn_of_few_samples(group, length > 0 ? group.area / (length * length) : fewest, warnings);
}

}  // namespace opaline
