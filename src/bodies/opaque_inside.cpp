// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies/opaque_inside.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

#include "geometry/follow_ray.h"

namespace opaline {
namespace {

const Vec3d kDirection = normalized(Vec3d{.31, .87, .39});  // along no axis

/// True if a ray from the point crosses the mesh an odd number of times.
bool is_enclosed(const RayScene& rays, std::uint32_t mesh, const Vec3d& point) {
  bool is_odd = false;
  follow_ray(rays, point, kDirection, std::numeric_limits<double>::infinity(), [&](const TracedRay& traced) {
    is_odd ^= traced.hit.mesh == mesh;
    return true;
  });
  return is_odd;
}

bool is_in(const Bounds& box, const Vec3d& point) {
  return min_component(point - box.low) > 0 && min_component(box.high - point) > 0;
}

/// Some vertices of a mesh in a box.
std::vector<Vec3d> vertices_in(const Mesh& mesh, const Bounds& box) {
  constexpr std::size_t kTested = 64;
  std::vector<Vec3d> all, some;
  for (const Vec3d& p : mesh.positions)
    if (is_in(box, p)) all.push_back(p);
  for (std::size_t i = 0; i < all.size(); i += std::max(all.size() / kTested, std::size_t{1}))
    some.push_back(all[i]);
  return some;
}

/// Fraction of a cube inside the meshes, by eight points.
double fraction_inside(const RayScene& rays, std::span<const std::uint32_t> meshes,
                       std::span<const Bounds> boxes, const Vec3d& centre, double width) {
  constexpr int kPoints = 8;
  int inside = 0;
  for (int corner = 0; corner < kPoints; ++corner) {
    const Vec3d apart(corner & 1 ? .25 : -.25, corner & 2 ? .25 : -.25, corner & 4 ? .25 : -.25);
    const Vec3d point = centre + apart * width;
    for (std::size_t i = 0; i < meshes.size(); ++i)
      if (is_in(boxes[i], point) && is_enclosed(rays, meshes[i], point)) {
        ++inside;
        break;
      }
  }
  return double(inside) / kPoints;
}

}  // namespace

bool is_inside(const RayScene& rays, const BodyPlan& body, const Vec3d& point) {
  int crossed = 0;
  follow_ray(rays, point, kDirection, std::numeric_limits<double>::infinity(), [&](const TracedRay& traced) {
    if (std::ranges::find(body.meshes, traced.hit.mesh) != body.meshes.end())
      crossed += leaves(traced.hit, kDirection) ? 1 : -1;
    return true;
  });
  return crossed > 0;
}

bool has_vertices_inside(const World& world, const RayScene& rays, const BodyPlan& body, std::uint32_t mesh) {
  constexpr double kConsiderable = .2;  // fraction of the diagonal
  const Bounds box = bounds(world, body.meshes);
  Bounds inside;
  for (const Vec3d& point : vertices_in(world.meshes[mesh], box))
    if (is_inside(rays, body, point)) widen(inside.low, inside.high, point);
  return inside.low.x <= inside.high.x &&
         length(inside.high - inside.low) > kConsiderable * length(box.high - box.low);
}

bool is_opaque_solid(const Scene& scene, const World& world, std::uint32_t mesh) {
  return !scene.shapes[mesh].medium && world.reports[mesh].open_edges == 0 &&
         !std::holds_alternative<QuadShape>(scene.shapes[mesh].source);
}

std::vector<std::uint32_t> opaque_beside(const Scene& scene, const World& world, const BodyPlan& body) {
  const auto meets = [&](std::uint32_t mesh) {
    return std::ranges::any_of(body.meshes,
                               [&](std::uint32_t own) { return meet(world.boxes[own], world.boxes[mesh]); });
  };
  std::vector<std::uint32_t> found;
  for (std::uint32_t mesh = 0; mesh < world.meshes.size(); ++mesh)
    if (is_opaque_solid(scene, world, mesh) && meets(mesh)) found.push_back(mesh);
  return found;
}

std::vector<std::uint32_t> opaque_inside(const Scene& scene, const World& world, const RayScene& rays,
                                         const BodyPlan& body) {
  std::vector<std::uint32_t> found = opaque_beside(scene, world, body);
  std::erase_if(found, [&](std::uint32_t mesh) { return !has_vertices_inside(world, rays, body, mesh); });
  return found;
}

MediaInside with_opaque_shapes(const World& world, const RayScene& rays, std::vector<std::uint32_t> meshes,
                               MediaInside inside, const std::array<HomogeneousMedium, 3>& throughout) {
  std::vector<Bounds> boxes;
  for (const std::uint32_t mesh : meshes) boxes.push_back(bounds(world.meshes[mesh]));
  return [&rays, meshes = std::move(meshes), boxes = std::move(boxes), inside = std::move(inside),
          throughout](const Vec3d& position, double width) {
    std::array<HomogeneousMedium, 3> media = inside ? inside(position, width) : throughout;
    const double black = fraction_inside(rays, meshes, boxes, position, width);
    for (HomogeneousMedium& medium : media) {
      medium.sigma_a += black * medium.sigma_s;
      medium.sigma_s -= black * medium.sigma_s;
    }
    return media;
  };
}

}  // namespace opaline
