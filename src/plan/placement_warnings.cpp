// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/placement_warnings.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/coincident_shapes.h"
#include "geometry/winding_number.h"
#include "lights/light.h"

namespace opaline {
namespace {

constexpr std::size_t kTested = 16;            // vertices of a mesh
constexpr std::size_t kMostPairs = 1'000'000;  // bodies times shapes
constexpr std::size_t kMostNamed = 3;          // bodies

bool is_opaque_and_closed(const Scene& scene, const World& world, std::size_t mesh) {
  return !scene.shapes[mesh].medium && world.reports[mesh].open_edges == 0;
}

/// True if the shape is around all tested vertices of the body.
bool is_around(const World& world, std::size_t shape, const BodyPlan& body) {
  const auto is_in_box = [&](std::size_t m) { return contains(world.boxes[shape], world.boxes[m]); };
  if (!std::ranges::all_of(body.meshes, is_in_box)) return false;
  const Bounds box = bounds(world, body.meshes);
  const Vec3d middle = .5 * (box.low + box.high);
  constexpr double kInner = .999;  // the body may touch the shape
  return std::ranges::all_of(body.meshes, [&](std::size_t m) {
    const std::vector<Vec3d>& positions = world.meshes[m].positions;
    const std::size_t step = std::max(positions.size() / kTested, std::size_t{1});
    for (std::size_t i = 0; i < positions.size(); i += step)
      if (!encloses(world.meshes[shape], middle + (positions[i] - middle) * kInner)) return false;
    return true;
  });
}

/// True if a part of the light's bounding sphere may be inside the mesh.
bool may_light(const World& world, const Light& light, const Mesh& mesh) {
  if (is_of_shape(light)) return true;
  const LightExtent lamp = extent(light);
  if (!lamp.center) return false;
  const Vec3d center = into_world(world, *lamp.center);
  const double radius = lamp.radius / world.unit;
  if (encloses(mesh, center)) return true;
  for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
    for (const double side : {-radius, radius})
      if (radius > 0 && encloses(mesh, center + axis * side)) return true;
  return false;
}

/// Effect on the bodies inside; empty: none.
std::string effect_of(const Scene& scene, const World& world, const Mesh& mesh) {
  if (!encloses(mesh, into_world(world, scene.camera.position)))
    return "the camera is outside, and sees only it";
  const auto lights = [&](const Light& light) { return may_light(world, light, mesh); };
  if (scene.lights.empty() || std::ranges::any_of(scene.lights, lights)) return {};
  return "all lights are outside";
}

std::string names_of(const std::vector<const BodyPlan*>& bodies) {
  std::string text;
  for (std::size_t i = 0; i < std::min(bodies.size(), kMostNamed); ++i)
    text += (i > 0 ? ", " : "") + bodies[i]->name;
  if (bodies.size() > kMostNamed) text += fmt::format(" and {} more", bodies.size() - kMostNamed);
  return text;
}

}  // namespace

std::vector<std::string> placement_warnings(const Scene& scene, const World& world, const Plan& plan) {
  std::vector<std::string> warnings = warnings_of_coincident_faces(scene, world);
  if (plan.groups.size() * world.meshes.size() > kMostPairs) return warnings;
  for (std::size_t m = 0; m < world.meshes.size(); ++m) {
    if (!is_opaque_and_closed(scene, world, m)) continue;
    std::vector<const BodyPlan*> enclosed;
    for (const BodyPlan& body : plan.groups)
      if (is_around(world, m, body)) enclosed.push_back(&body);
    if (enclosed.empty()) continue;
    if (const std::string effect = effect_of(scene, world, world.meshes[m]); !effect.empty())
      warnings.push_back(
          fmt::format("{}: inside the closed opaque shape '{}'; {}; remove the shape, or one side of it",
                      names_of(enclosed), scene.shapes[m].name, effect));
  }
  return warnings;
}

}  // namespace opaline
