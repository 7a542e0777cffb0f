// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/choose_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "bodies/local_media.h"
#include "diffusion/diffuse_profile.h"
#include "plan/body_groups.h"
#include "plan/expected_error.h"
#include "plan/local_thickness.h"
#include "scene/names.h"
#include "scene/scene_properties.h"
#include "subsurface/method.h"
#include "subsurface/plan_samples.h"

namespace opaline {
namespace {

constexpr ProfileKind kOfBodies = ProfileKind::normalized_diffusion;
constexpr ProfileKind kOfThickPlates = ProfileKind::dipole;
// Alignment of a square plate with a thickness of a sixth of its width.
constexpr double kFlatAlignment = .58;
// Plates thicker than this many diffuse mean free paths, in the channel with the longest, transmit less than
// 2 %.
constexpr double kCrossed = 4;

/// Extremes of a medium over its scattering channels.
struct MediumExtremes {
  double mean_free_path = 0, diffuse_mean_free_path = 0;  ///< the longest, mm
  std::string channels;  ///< channels with the longest mean free path: "red", "red, green"
  double absorbed = 0;   ///< 1 - reduced albedo, the largest
};

/// Expected error: a base value, plus terms for thin bodies and dark media.
struct ErrorTerms {
  double base, thin, dark;
  double power = 1;  ///< exponent of the thickness, mean free paths
  double at(double mean_free_paths, const MediumExtremes& medium) const {
    return std::min(1., base + thin / std::pow(mean_free_paths, power) + dark * medium.absorbed);
  }
};
// Fitted to the table of bench_volume_models; `thin` of diffusion to bodies lit from behind.
constexpr ErrorTerms kErrorOfBodies{.05, .9, .5}, kErrorOfPlates{.07, .25, .55},
    kErrorOfDiffusion{.025, .04, .14, 2};

constexpr std::array<const char*, 3> kChannels{"red", "green", "blue"};

MediumExtremes extremes_of(Medium medium) {
  medium.profile = kOfBodies;
  const DiffuseProfile profile = make_diffuse_profile(medium);
  MediumExtremes extremes;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(profile.total[c] > 0) || is_local(profile, c)) continue;
    const double length = profile.mean_free_path[c], decay = length / profile.diffuse_mean_free_path[c];
    if (length > extremes.mean_free_path) extremes.channels.clear();
    if (length >= extremes.mean_free_path)
      extremes.channels += (extremes.channels.empty() ? "" : ", ") + std::string(kChannels[c]);
    extremes.mean_free_path = std::max(extremes.mean_free_path, length);
    extremes.diffuse_mean_free_path =
        std::max(extremes.diffuse_mean_free_path, profile.diffuse_mean_free_path[c]);
    extremes.absorbed = std::max(extremes.absorbed, decay * decay / 3);  // sigma_tr^2 is 3 sigma_a sigma_t'
  }
  return extremes;
}

BodyShape shape_of(const BodyPlan& group) {
  return {group.area, group.thickness, group.alignment};
}

/// True if a radial profile shades the body: `auto` prefers it to volume_diffusion where cells cannot resolve layers.
bool uses_a_profile(const Scene& scene, const World& world, const BodyPlan& group, std::size_t bodies) {
  switch (scene.settings.method) {
    case Method::hierarchical:
    case Method::direct:
      return true;
    case Method::automatic:
      return is_too_large_for_layers(scene, world, fewest_samples(bodies), group);
    default:
      return false;
  }
}

/// Layers are walked: the equivalent medium is inaccurate where one absorbs much (`opaline profile` prints by how much).
BodyModel model_of(const Scene& scene, const World& world, const BodyPlan& group, const BodyShape& shape,
                   std::size_t bodies) {
  const Medium& medium = scene.media[group.medium];
  BodyModel model = choose_model(medium, shape);
  if (medium.layers.empty() || model.profile.kind == ProfileKind::multipole ||
      !uses_a_profile(scene, world, group, bodies))
    return model;
  model.profile = {.kind = ProfileKind::tabulated};
  model.reason = "layers, " + model.reason;
  return model;
}

// Root mean square over the places: ears are more wrong than the head.
double error_of_diffusion(const BodyShape& shape, double thickness, const MediumExtremes& medium) {
  constexpr double kMost = .5;  // largest error of a place, unless that of the mean thickness is larger
  const double of_mean = kErrorOfDiffusion.at(thickness / medium.mean_free_path, medium);
  if (shape.local.empty()) return of_mean;
  double squares = 0;
  for (const double local : shape.local) {
    const double mean_free_paths = std::min(local, thickness) / medium.mean_free_path;
    const double error = std::min(std::max(kMost, of_mean), kErrorOfDiffusion.at(mean_free_paths, medium));
    squares += error * error;
  }
  return std::sqrt(squares / double(shape.local.size()));
}

std::string two_digits(double value) {
  return value < 100 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

/// " = 12 mean free paths", or a bound on the number.
std::string mean_free_paths_text(double count) {
  if (count > 1e6) return ", more than a million mean free paths";
  if (count < 1e-6) return ", less than a millionth of a mean free path";
  return fmt::format(" = {} mean free paths", two_digits(count));
}

std::string percent_text(double error) {
  return fmt::format("{:.{}f} %", 100 * error, error < .0995 ? 1 : 0);
}

}  // namespace

double BodyShape::plate_thickness() const {
  const double rim = 2 * std::numbers::sqrt2 * thickness / std::sqrt(area);
  return rim < 1 ? thickness / (1 - rim) : thickness;
}

bool BodyShape::is_flat() const {
  return thickness > 0 && alignment > kFlatAlignment;
}

BodyModel choose_model(const Medium& medium, const BodyShape& shape) {
  BodyModel model{{kOfBodies}, true, {}, {}, {}};
  if (!(shape.thickness > 0)) {
    model.reason = "open mesh, so thickness and error are unknown";
    return model;
  }
  const bool is_flat = shape.is_flat();
  const double thickness = is_flat ? shape.plate_thickness() : shape.thickness;
  const MediumExtremes extremes = extremes_of(medium);
  if (!(extremes.mean_free_path > 0)) {
    model.reason = "no mean free path, diffuse reflection";
    return model;
  }
  const double mean_free_paths = thickness / extremes.mean_free_path;
  model.expected_error = (is_flat ? kErrorOfPlates : kErrorOfBodies).at(mean_free_paths, extremes);
  constexpr double kMuch = 1.5;
  model.expected_error_of_diffusion = error_of_diffusion(shape, thickness, extremes);
  model.has_thin_parts =
      *model.expected_error_of_diffusion > kMuch * kErrorOfDiffusion.at(mean_free_paths, extremes);
  const std::string size = fmt::format("{} mm{} ({})", two_digits(thickness),
                                       mean_free_paths_text(mean_free_paths), extremes.channels);
  if (is_flat && thickness < kCrossed * extremes.diffuse_mean_free_path) {
    model.profile.kind = ProfileKind::multipole;
    model.profile.thickness = thickness;
    model.reason = "flat, thickness " + size;
  } else if (is_flat) {
    model.profile.kind = kOfThickPlates;
    model.reason = "flat, too thick for light to cross, thickness " + size;
  } else {
    model.reason = "mean thickness " + size;
  }
  return model;
}

std::string model_text(const BodyModel& model) {
  return fmt::format("{}: {}", name_of(model.profile.kind), model.reason);
}

std::string model_error_text(const BodyModel& model, Method method, bool reenters) {
  const std::optional<double> own = expected_error(model, method);
  if (!own) return {};
  std::string text = "expected model error " + percent_text(*own);
  if (method == Method::volume_diffusion && model.has_thin_parts)
    text += ", most of it at thin parts; several times as much if they are lit from behind alone";
  if (!reenters) text += " (without re-entry)";
  if (method == Method::volume_diffusion || !model.expected_error_of_diffusion) return text;
  return text + "; --method volume_diffusion: " + percent_text(*model.expected_error_of_diffusion);
}

BodyModel planned_model(const Scene& scene, const World& world, const BodyPlan& group, std::size_t bodies) {
  const Medium& medium = scene.media[group.medium];
  BodyShape shape = shape_of(group);
  if (method_of(scene.settings.method).has_model() && shape.thickness > 0)
    shape.local = local_thicknesses(world, group.meshes);
  BodyModel model = model_of(scene, world, group, shape, bodies);
  if (medium.profile) {
    model.is_chosen = false;
    model.reason = "set by the scene";
    model.expected_error = {};
  } else if (model.profile != medium.chosen) {
    model.reason = "as in the reference frame";
  }
  model.profile = {profile_kind(medium), profile_thickness(medium), profile_fit(medium)};
  return model;
}

void choose_models(Scene& scene, const World& world, std::span<const BodyPlan> reference) {
  if (std::ranges::all_of(scene.media, [](const Medium& m) { return m.profile.has_value(); })) return;
  std::vector<std::string> warnings;  // added by make_plan
  std::vector<bool> is_taken(scene.media.size());
  const std::vector<BodyPlan> groups = find_groups(scene, world, warnings);
  for (const BodyPlan& group : groups) {
    if (scene.media[group.medium].profile) continue;
    const auto before = std::ranges::find_if(reference, [&](const BodyPlan& other) {
      return other.name == group.name && other.shared == group.shared && other.model.is_chosen;
    });
    const ChosenProfile chosen = before != reference.end()
                                     ? before->model.profile
                                     : model_of(scene, world, group, shape_of(group), groups.size()).profile;
    std::size_t index = group.medium;
    if (is_taken[index] && scene.media[index].chosen != chosen) {
      scene.media.push_back(scene.media[index]);
      is_taken.push_back(false);
      index = scene.media.size() - 1;
      for (const std::uint32_t shape : group.meshes) scene.shapes[shape].medium = index;
    }
    is_taken[index] = true;
    scene.media[index].chosen = chosen;
  }
}

}  // namespace opaline
