// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/outer_shares.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/random.h"
#include "geometry/surface_point.h"
#include "volume/nearest_sample.h"
#include "volume/outer_surface.h"

namespace opaline {
namespace {

constexpr std::size_t kPointsOfCell = 64;

struct Triangle {
  std::uint32_t mesh, index;
  double area_up_to_here;
};

struct TestedPoint {
  std::uint32_t sample;
  float share;
};

std::vector<Triangle> triangles_of(const World& world, std::span<const std::uint32_t> meshes) {
  std::vector<Triangle> triangles;
  double area = 0;
  for (const std::uint32_t m : meshes) {
    const Mesh& mesh = world.meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3d corner(mesh.positions[a]);
      area += length(cross(Vec3d(mesh.positions[b]) - corner, Vec3d(mesh.positions[c]) - corner)) / 2;
      triangles.push_back({m, t, area});
    }
  }
  return triangles;
}

}  // namespace

std::vector<float> outer_shares(const RayScene& rays, const World& world,
                                std::span<const std::uint32_t> meshes,
                                std::span<const SurfaceSample> samples) {
  const OuterSurface outer(rays, world, meshes, 0);
  const NearestSample cells(samples, &world);
  const std::vector<Triangle> triangles = triangles_of(world, meshes);
  std::vector<TestedPoint> points(kPointsOfCell * samples.size());
  parallel_chunks(points.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const double area = triangles.back().area_up_to_here * (double(i) + .5) / double(points.size());
      const Triangle& triangle = *std::ranges::lower_bound(triangles, area, {}, &Triangle::area_up_to_here);
      auto [u, v] = r2_point(i, {});
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const SurfacePoint point =
          surface_point(world.meshes[triangle.mesh], triangle.index, float(u), float(v));
      points[i] = {cells.at(point.position, point.geometric),
                   outer.of({point.position, Vec3d(point.geometric), triangle.mesh, triangle.index}).share};
    }
  });
  std::vector<float> shares(samples.size());
  std::vector<std::uint32_t> counts(samples.size());
  for (const TestedPoint& point : points) {
    shares[point.sample] += point.share;
    ++counts[point.sample];
  }
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (counts[i] > 0) shares[i] /= float(counts[i]);
  return shares;
}

}  // namespace opaline
