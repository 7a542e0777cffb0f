// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/carry_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/parallel.h"
#include "geometry/surface_point.h"
#include "sampling/cell_parts.h"
#include "sampling/stretched_cloud.h"

namespace opaline {
namespace {

struct Frame {
  Vec3d origin, x, y, z;
};

Frame frame_of(const Mesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3d origin = mesh.positions[a], x = normalized(mesh.positions[b] - origin),
              z = normalized(cross(x, mesh.positions[c] - origin));
  return {origin, x, cross(z, x), z};
}

/// A rotation and a translation.
struct Motion {
  Frame from, to;
  Vec3d turn(const Vec3d& v) const {
    return to.x * dot(v, from.x) + to.y * dot(v, from.y) + to.z * dot(v, from.z);
  }
  Vec3d operator()(const Vec3d& p) const { return to.origin + turn(p - from.origin); }
};

double double_area(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return length(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
}

/// Largest deviation of vertices from a rigid motion, mm.
double most_apart(const Mesh& mesh) {
  const Bounds box = bounds(mesh);
  return 1e-6 * length(box.high - box.low);
}

/// True if some edge lengths change, which excludes rigid motion.
bool has_other_edges(const CarryInput& input) {
  constexpr std::size_t kLooks = 64;
  for (std::size_t m = 0; m < input.from_meshes.size(); ++m) {
    const Mesh &before = input.from.meshes[input.from_meshes[m]],
               &after = input.to.meshes[input.to_meshes[m]];
    const double most = 3 * most_apart(before);
    const std::size_t step = before.triangles.size() / kLooks + 1;
    for (std::size_t t = 0; t < before.triangles.size(); t += step) {
      const auto& [a, b, c] = before.triangles[t];
      const auto differs = [&](std::uint32_t i, std::uint32_t j) {
        return std::abs(length(before.positions[i] - before.positions[j]) -
                        length(after.positions[i] - after.positions[j])) > most;
      };
      if (differs(a, b) || differs(b, c) || differs(c, a)) return true;
    }
  }
  return false;
}

/// Rigid motion of the first mesh's largest triangle, if it applies to all vertices.
std::optional<Motion> common_motion(const CarryInput& input) {
  if (has_other_edges(input)) return {};
  const Mesh &before = input.from.meshes[input.from_meshes[0]], &after = input.to.meshes[input.to_meshes[0]];
  std::uint32_t largest = 0;
  for (std::uint32_t t = 0; t < before.triangles.size(); ++t)
    if (double_area(before, t) > double_area(before, largest)) largest = t;
  const Motion motion{frame_of(before, largest), frame_of(after, largest)};
  for (std::size_t m = 0; m < input.from_meshes.size(); ++m) {
    const std::vector<Vec3d>& p = input.from.meshes[input.from_meshes[m]].positions;
    const std::vector<Vec3d>& q = input.to.meshes[input.to_meshes[m]].positions;
    const double most = most_apart(input.from.meshes[input.from_meshes[m]]);
    for (std::size_t i = 0; i < p.size(); ++i)
      if (!(length(motion(p[i]) - q[i]) <= most)) return {};
  }
  return motion;
}

/// Index into from_meshes of each mesh of the world before.
std::vector<std::size_t> places_of(std::span<const std::uint32_t> meshes) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    places.resize(std::max<std::size_t>(places.size(), meshes[i] + 1));
    places[meshes[i]] = i;
  }
  return places;
}

SurfaceSamples moved(const CarryInput& input, const Motion& motion) {
  SurfaceSamples result = input.samples;
  const std::vector<std::size_t> place = places_of(input.from_meshes);
  parallel_chunks(result.samples.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      SurfaceSample& s = result.samples[i];
      const Vec3d offset = Vec3d(s.centroid) - Vec3d(s.position);
      s.mesh = input.to_meshes[place[s.mesh]];
      const SurfacePoint point = surface_point(input.to.meshes[s.mesh], s.triangle, s.u, s.v);
      s.position = point.position;
      s.normal = point.normal;
      s.centroid = Vec3f(Vec3d(point.position) + motion.turn(offset));
    }
  });
  return result;
}

/// Each sample by its triangle's index in the list.
std::vector<SampleGrid::Place> carried_places(const CarryInput& input, const TriangleList& triangles) {
  const std::vector<std::size_t> place = places_of(input.from_meshes);
  std::vector<std::vector<std::uint32_t>> listed(input.from_meshes.size());  // place of each mesh's triangles
  for (std::size_t m = 0; m < listed.size(); ++m)
    listed[m].resize(input.from.meshes[input.from_meshes[m]].triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    listed[place[triangles.id(t).mesh]][triangles.id(t).triangle] = t;
  std::vector<SampleGrid::Place> places;
  for (const SurfaceSample& s : input.samples.samples)
    places.push_back({listed[place[s.mesh]][s.triangle], s.u, s.v});
  return places;
}

/// Numbers of the grid's samples in the final order.
std::vector<std::uint32_t> finished_order(const TriangleList& triangles, const SampleGrid& grid) {
  std::vector<std::uint32_t> order(grid.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const SampleGrid::Place &p = grid.place(a), &q = grid.place(b);
    const TriangleId of_p = triangles.id(p.triangle), of_q = triangles.id(q.triangle);
    return std::tie(of_p.mesh, of_p.triangle, p.u, p.v) < std::tie(of_q.mesh, of_q.triangle, q.u, q.v);
  });
  return order;
}

SurfaceSample finished_sample(TriangleId id, float u, float v, const SurfacePoint& point,
                              const SurfaceShare& share) {
  const Vec3f offset = share.area > 0 ? Vec3f(share.moment / share.area) : Vec3f{};
  return {
      id.mesh, id.triangle, u, v, point.position, point.normal, float(share.area), point.position + offset};
}

SurfaceSamples divided_anew(const CarryInput& input, const TriangleList& triangles, const SampleGrid& grid) {
  const double radius = input.samples.radius;
  const std::vector<SurfaceShare> shares = surface_shares(triangles, grid, float(radius), input.monitor);
  const std::vector<std::uint32_t> order = finished_order(triangles, grid);
  SurfaceSamples result{std::vector<SurfaceSample>(order.size()), triangles.area(), radius};
  parallel_chunks(order.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const SampleGrid::Place& place = grid.place(order[i]);
      const TriangleId id = triangles.id(place.triangle);
      const SurfacePoint point = surface_point(triangles.mesh(id), id.triangle, place.u, place.v);
      result.samples[i] = finished_sample(id, place.u, place.v, point, shares[order[i]]);
    }
  });
  return result;
}

/// Cells of the original surface, for samples without cells.
SurfaceCells divided_before(const CarryInput& input) {
  const TriangleList triangles(input.from, input.from_meshes);
  const float radius = float(input.samples.radius);
  const SampleGrid grid =
      StretchedCloud(triangles, triangles, radius, carried_places(input, triangles)).grid();
  std::vector<SurfacePiece> pieces;
  surface_shares(triangles, grid, radius, input.monitor, &pieces);
  return collect_cells(triangles, pieces, finished_order(triangles, grid), input.from_meshes);
}

/// New positions of the samples.
std::vector<SurfacePoint> points_after(const CarryInput& input) {
  const std::vector<SurfaceSample>& samples = input.samples.samples;
  const std::vector<std::size_t> place = places_of(input.from_meshes);
  std::vector<SurfacePoint> points(samples.size());
  parallel_chunks(samples.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfaceSample& s = samples[i];
      points[i] = surface_point(input.to.meshes[input.to_meshes[place[s.mesh]]], s.triangle, s.u, s.v);
    }
  });
  return points;
}

/// True if samples may have to be removed or added.
bool may_need_mending(const CarryInput& input, std::span<const PlainTriangle> before,
                      std::span<const PlainTriangle> after, std::span<const SurfacePoint> points) {
  for (std::size_t t = 0; t < after.size(); ++t)
    if (double(after[t].area) > kGrown * double(before[t].area)) return true;
  std::vector<Standing> standing(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) standing[i] = {points[i].position, points[i].geometric};
  return any_closer(standing, kClosest * float(input.samples.radius));
}

CarriedSamples bent_along(const CarryInput& input, std::span<const PlainTriangle> triangles,
                          std::span<const SurfacePoint> points) {
  const bool divide = input.cells.empty();
  if (divide) input.cells = divided_before(input);
  const std::vector<SurfaceSample>& samples = input.samples.samples;
  const std::vector<std::size_t> place = places_of(input.from_meshes);
  SurfaceSamples result{std::vector<SurfaceSample>(samples.size()), 0, input.samples.radius};
  for (const PlainTriangle& triangle : triangles) result.area += double(triangle.area);
  parallel_chunks(samples.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfaceSample& s = samples[i];
      result.samples[i] = finished_sample({input.to_meshes[place[s.mesh]], s.triangle}, s.u, s.v, points[i],
                                          carried_share(input.cells, i, triangles, points[i].position));
    }
  });
  return {.surface = std::move(result), .divided = divide};
}

/// World in another unit, as far as carrying samples requires.
World in_unit(const World& world, double unit) {
  const double factor = world.unit / unit;
  World scaled;
  scaled.meshes = world.meshes;
  scaled.unit = unit;
  for (Mesh& mesh : scaled.meshes)
    for (Vec3d& p : mesh.positions) p = p * factor;
  return scaled;
}

SurfaceSamples in_unit(const SurfaceSamples& surface, double factor) {
  SurfaceSamples scaled = surface;
  scaled.area *= factor * factor;
  scaled.radius *= factor;
  for (SurfaceSample& s : scaled.samples) {
    s.position = s.position * float(factor);
    s.centroid = s.centroid * float(factor);
    s.area *= float(factor * factor);
  }
  return scaled;
}

}  // namespace

bool can_carry(const World& from, std::span<const std::uint32_t> from_meshes, const World& to,
               std::span<const std::uint32_t> to_meshes) {
  return !from_meshes.empty() &&
         std::ranges::equal(from_meshes, to_meshes, [&](std::uint32_t a, std::uint32_t b) {
           return from.meshes[a].positions.size() == to.meshes[b].positions.size() &&
                  from.meshes[a].triangles == to.meshes[b].triangles;
         });
}

CarriedSamples carry_samples(const CarryInput& input) {
  if (input.from.unit != input.to.unit)
    return carry_samples({in_unit(input.from, input.to.unit), input.from_meshes, input.to, input.to_meshes,
                          in_unit(input.samples, input.from.unit / input.to.unit), input.cells,
                          input.monitor});
  if (const std::optional<Motion> motion = common_motion(input)) return {moved(input, *motion), true};
  const std::vector<PlainTriangle> plain = plain_triangles(input.to, input.to_meshes);
  const std::vector<SurfacePoint> points = points_after(input);
  if (!may_need_mending(input, plain_triangles(input.from, input.from_meshes), plain, points))
    return bent_along(input, plain, points);
  const TriangleList before(input.from, input.from_meshes),
      after(input.to, input.to_meshes, before, input.from_meshes);
  if (input.monitor != nullptr) input.monitor->begin("sampling", after.size());
  StretchedCloud cloud(before, after, float(input.samples.radius), carried_places(input, before));
  CarriedSamples result;
  result.removed = cloud.remove_crowded(kClosest);
  result.added = cloud.fill_gaps(kWidest);
  if (result.removed + result.added == 0) return bent_along(input, plain, points);
  result.surface = divided_anew(input, after, cloud.grid());
  result.divided = true;
  return result;
}

}  // namespace opaline
