// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/check_reach.h"

#include <fmt/format.h>

#include "lights/light.h"
#include "opaline/error.h"

namespace opaline {
namespace {

constexpr double kFarthest = 0x1p50, kBrightest = 1e30;

/// The largest distance of a light's points from zero, at most some times too large.
double reach_of(const Light& light) {
  const LightExtent place = extent(light);
  return place.center ? length(*place.center) + place.radius : 0;
}

void check_distance(const Scene& scene, const std::string& what, double distance, double mm) {
  if (distance <= kFarthest) return;
  throw bad_file(
      scene.file, what + " is too far from the shapes",
      fmt::format(
          "at most {:.3g} mm from their centre (2^50 times the internal unit), the limit of single precision",
          kFarthest * mm),
      fmt::format("{:.3g} mm", distance * mm));
}

}  // namespace

void check_reach(const Scene& scene, const World& world) {
  if (world.meshes.empty()) return;
  check_distance(scene, "camera.position", length(into_world(world, scene.camera.position)), world.unit);
  for (const Light& light : scene.lights) {
    const Light moved = recentred(light, world.origin, world.unit);
    const std::string name = "the light '" + light.name + "'";
    check_distance(scene, name, reach_of(moved), world.unit);
    const double brightest = max_component(emission(moved));
    if (brightest > kBrightest)
      throw bad_file(scene.file, name + " is too bright for shapes of this size",
                     fmt::format("at most {:.3g} W/sr", kBrightest * world.unit * world.unit),
                     fmt::format("{:.3g} W/sr", max_component(emission(light))));
  }
}

}  // namespace opaline
