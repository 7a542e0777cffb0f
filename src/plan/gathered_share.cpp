// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/gathered_share.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

namespace opaline {
namespace {

constexpr std::size_t kMostShapes = 64;               // beyond, the share counts as 1 to save time
constexpr int kPoints = 64, kRings = 4, kAround = 6;  // points of a mesh; directions at each

/// Share of rays meeting the shape they start from, at most.
double own_share(const ShapeSource& source) {
  if (std::holds_alternative<MeshFile>(source)) return .4;
  return std::holds_alternative<TorusShape>(source) ? .3 : 0;
}

bool meets(const Bounds& box, const Vec3d& from, const Vec3d& along) {
  double near = 0, far = HUGE_VAL;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0) {
      if (from[axis] < box.low[axis] || from[axis] > box.high[axis]) return false;
      continue;
    }
    const double a = (box.low[axis] - from[axis]) / along[axis],
                 b = (box.high[axis] - from[axis]) / along[axis];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near < far;
}

/// Share of the rays from one mesh's surface, distributed by the cosine, meeting a box of the others.
double share_of(const World& world, std::size_t m, std::span<const Bounds> boxes) {
  const Mesh& mesh = world.meshes[m];
  double met = 0, all = 0;
  for (int k = 0; k < kPoints && !mesh.triangles.empty(); ++k) {
    const auto& [a, b, c] = mesh.triangles[mesh.triangles.size() * std::size_t(k) / kPoints];
    const Vec3d corner = mesh.positions[a], u = mesh.positions[b] - corner, v = mesh.positions[c] - corner;
    const Vec3d twice = cross(u, v);
    const double area = length(twice);
    if (!(area > 0)) continue;
    const double side = std::sqrt(std::fmod(k * .7548776662466927, 1)),  // evenly over a triangle
        across = std::fmod(k * .5698402909980532, 1) * side;
    const Vec3d point = corner + u * (side - across) + v * across, normal = twice / area;
    const Vec3d tangent = normalized(u), other = cross(normal, tangent);
    for (int direction = 0; direction < kRings * kAround; ++direction) {
      const double sine = std::sqrt((direction / kAround + .5) / kRings),
                   angle = 2 * std::numbers::pi * (direction % kAround + (k % 2) * .5) / kAround;
      const Vec3d along = normal * std::sqrt(1 - sine * sine) + tangent * (sine * std::cos(angle)) +
                          other * (sine * std::sin(angle));
      all += area;
      for (std::size_t other_mesh = 0; other_mesh < boxes.size(); ++other_mesh)
        if (other_mesh != m && meets(boxes[other_mesh], point, along)) {
          met += area;
          break;
        }
    }
  }
  return all > 0 ? met / all : 0;
}

}  // namespace

double gathered_share(const Scene& scene, const World& world) {
  if (world.meshes.size() > kMostShapes) return 1;
  std::vector<Bounds> boxes;
  for (const Bounds& box : world.boxes)
    boxes.push_back({into_world(world, box.low), into_world(world, box.high)});
  double most = 0;
  for (std::size_t m = 0; m < world.meshes.size() && most < kLargeShare; ++m)
    most = std::max(most, own_share(scene.shapes[m].source) + share_of(world, m, boxes));
  return std::min(1., most);
}

}  // namespace opaline
