// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/render/plate_model.h"

#include <algorithm>
#include <cmath>

#include "opaline/diffusion/diffuse_profile.h"

namespace opaline {
namespace {

// Beyond this many mean free paths little goes through.
constexpr double kThick = 10;
// Area over thickness squared: a ball has 28, a cube 54, a plate ten times as wide as thick 345.
constexpr double kFlat = 200;
constexpr std::size_t kWalks = 20000;  // standard error of a share: .35 % at most

PlateModel compare_plate(const GroupPlan& group, double thickness, const DiffuseProfile& medium) {
  PlateModel plate{group.name, thickness, {}, {}, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(medium.total[c] > 0 && medium.mean_free_path[c] > 0)) continue;
    const double decay = medium.mean_free_path[c] / medium.diffuse_mean_free_path[c];
    plate.optical_thickness[c] = thickness / medium.mean_free_path[c];
    plate.profile[c] = slab_by_profile(medium.channels[c], thickness);
    // A thick plate is what one of kThick is, within the walks' noise, and light would walk in it for long.
    plate.walks[c] = slab_by_walks(1 - decay * decay / 3, std::min(plate.optical_thickness[c], 2 * kThick),
                                   medium.eta, kWalks);
  }
  return plate;
}

}  // namespace

std::vector<PlateModel> compare_plates(const Scene& scene, const World& world, const Plan& plan) {
  std::vector<PlateModel> plates;
  for (const GroupPlan& group : plan.groups) {
    if (group.meshes.size() != 1) continue;
    const double unit = world.unit, area = group.area,
                 thickness = 2 * enclosed_volume(world.meshes[group.meshes[0]]) * unit * unit * unit / area;
    const DiffuseProfile medium = make_diffuse_profile(scene.media[group.medium]);
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c)
      if (medium.total[c] > 0) longest = std::max(longest, medium.mean_free_path[c]);
    const bool is_flat = thickness > 0 && area > kFlat * thickness * thickness;
    if (is_flat && thickness < kThick * longest) plates.push_back(compare_plate(group, thickness, medium));
  }
  return plates;
}

}  // namespace opaline
