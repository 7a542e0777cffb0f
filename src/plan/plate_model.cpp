// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/plate_model.h"

#include <algorithm>
#include <utility>

#include "diffusion/diffuse_profile.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

// Thickness, in mean free paths, above which the transmittance is small.
constexpr double kThick = 10;
// Area over thickness squared: 28 of a ball, 54 of a cube, 345 of a plate ten times as wide as thick.
constexpr double kFlat = 200;
constexpr std::size_t kWalks = 20000;  // standard error of a fraction: at most 0.35 %

std::optional<PlateChannel> compare_channel(const DiffuseProfile& medium, std::size_t c, double thickness) {
  const double length = medium.mean_free_path[c];
  if (!(medium.total[c] > 0 && thickness < kThick * length)) return {};
  const double decay = length / medium.diffuse_mean_free_path[c];  // its square is 3 (1 - reduced albedo)
  return PlateChannel{thickness / length, slab_by_profile(medium.channels[c], thickness),
                      slab_by_walks(1 - decay * decay / 3, thickness / length, medium.eta, kWalks)};
}

}  // namespace

std::vector<PlateModel> compare_plates(const Scene& scene, const Plan& plan) {
  std::vector<PlateModel> plates;
  for (const BodyPlan& group : plan.groups) {
    const double thickness = group.thickness;
    if (group.meshes.size() != 1 || !(thickness > 0) || group.area < kFlat * thickness * thickness) continue;
    const Medium& medium = scene.media[group.medium];
    const DiffuseProfile profile = make_diffuse_profile(medium);
    PlateModel plate{group.name, profile_kind(medium), thickness, {}};
    for (std::size_t c = 0; c < 3; ++c) plate.channels[c] = compare_channel(profile, c, thickness);
    if (std::ranges::any_of(plate.channels, [](const auto& channel) { return channel.has_value(); }))
      plates.push_back(std::move(plate));
  }
  return plates;
}

}  // namespace opaline
