// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/body_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "diffusion/diffuse_profile.h"
#include "opaline/error.h"
#include "scene/source_place.h"

namespace opaline {
namespace {

/// 0: of no channel scattering is it longer.
double smallest_mean_free_path(const DiffuseProfile& profile, const Medium& medium) {
  double smallest = medium.shortest_path > 0 ? medium.shortest_path : INFINITY;
  for (std::size_t c = 0; c < 3; ++c)
    if (profile.total[c] > 0 && profile.mean_free_path[c] > 0)
      smallest = std::min(smallest, profile.mean_free_path[c]);
  return std::isfinite(smallest) ? smallest : 0;
}

/// mm; 0 where a mesh is open
double mean_thickness(const World& world, const BodyPlan& group) {
  double volume = 0;
  for (const std::uint32_t m : group.meshes) {
    if (world.reports[m].open_edges > 0) return 0;
    volume += world.measures[m].volume;
  }
  return 2 * volume * world.unit * world.unit * world.unit / group.area;
}

// The sum of the squares of the elements of the mean n n^T is the mean of (n . m)^2 over two normals n and m.
double alignment_of(const World& world, const BodyPlan& group) {
  std::array<double, 6> sums{};
  double area = 0;
  for (const std::uint32_t m : group.meshes) {
    const MeshMeasures& measures = world.measures[m];
    area += measures.area;
    for (std::size_t p = 0; p < sums.size(); ++p) sums[p] += measures.normal_products[p];
  }
  double squares = 0;
  for (std::size_t p = 0; p < sums.size(); ++p) squares += (p < 3 ? 1 : 2) * sums[p] * sums[p];
  return area > 0 ? squares / (area * area) : 0;
}

/// error where a method cannot use a medium's profile
void check_profile(const Scene& scene, const Medium& medium) {
  const Method method = scene.settings.method;  // `auto` uses the profiles that a scene sets
  if (medium.profile != ProfileKind::directional_dipole ||
      (method != Method::hierarchical && method != Method::automatic))
    return;
  throw Error(ErrorKind::bad_input, medium.place.file, medium.place.line, medium.place.column,
              fmt::format("{}: the profile directional_dipole requires the direction of the light, but the "
                          "samples of the method hierarchical store irradiance over all directions",
                          medium.name),
              "--method direct, or another profile, such as better_dipole");
}

}  // namespace

std::vector<BodyPlan> find_groups(const Scene& scene, const World& world,
                                  std::vector<std::string>& warnings) {
  std::vector<BodyPlan> groups;
  std::vector<std::optional<DiffuseProfile>> profiles(scene.media.size());
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const Shape& shape = scene.shapes[i];
    if (!shape.medium) continue;
    check_profile(scene, scene.media[*shape.medium]);
    std::optional<DiffuseProfile>& known = profiles[*shape.medium];
    if (!known) known = make_diffuse_profile(scene.media[*shape.medium]);
    const DiffuseProfile& profile = *known;
    if (!profile.translucent) {
      const Medium& medium = scene.media[*shape.medium];
      warnings.push_back(text_at(
          medium.place, fmt::format("{}: the medium {} does not scatter, so its diffuse reflection is black",
                                    shape.name, medium.name)));
      continue;
    }
    const std::string& name = shape.group.empty() ? shape.name : shape.group;
    auto it = groups.end();
    if (!shape.group.empty())
      it = std::ranges::find_if(groups, [&](const BodyPlan& g) { return g.shared && g.name == name; });
    if (it == groups.end()) {
      groups.push_back(
          {.name = name,
           .shared = !shape.group.empty(),
           .meshes = {},
           .medium = *shape.medium,
           .smallest_mean_free_path = smallest_mean_free_path(profile, scene.media[*shape.medium]),
           .reason = {}});
      it = groups.end() - 1;
    }
    it->meshes.push_back(std::uint32_t(i));
    it->area += world.measures[i].area * world.unit * world.unit;
  }
  for (BodyPlan& group : groups) {
    group.thickness = mean_thickness(world, group);
    group.alignment = alignment_of(world, group);
  }
  return groups;
}

}  // namespace opaline
