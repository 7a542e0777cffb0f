// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/boundary_points.h"

#include <algorithm>
#include <cmath>

#include "opaline/core/parallel.h"
#include "opaline/geometry/surface_point.h"
#include "opaline/volume/nearest_sample.h"

namespace opaline {
namespace {

constexpr int kMostParts = 4096;  // along an edge

// Centres of n^2 equal parts of a triangle.
template <class Found>
void divide(const std::array<Vec3d, 3>& p, int n, const Found& found) {
  for (int row = 0; row < n; ++row)
    for (int i = 0; i < 2 * (n - row) - 1; ++i) {
      const double third = i % 2 == 0 ? 1. / 3 : 2. / 3;
      const double v = (row + third) / n, u = (i / 2 + third) / n;
      found(p[0] + (p[1] - p[0]) * u + (p[2] - p[0]) * v);
    }
}

}  // namespace

std::vector<BoundaryPoint> boundary_points(const World& world, std::span<const std::uint32_t> meshes,
                                           std::span<const SurfaceSample> samples, double spacing) {
  std::vector<BoundaryPoint> points;
  for (const std::uint32_t m : meshes) {
    const Mesh& mesh = world.meshes[m];
    for (const auto& [i, j, k] : mesh.triangles) {
      const std::array<Vec3d, 3> p{mesh.positions[i], mesh.positions[j], mesh.positions[k]};
      const Vec3d across = cross(p[1] - p[0], p[2] - p[0]);
      const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
      const int n = int(std::clamp(std::ceil(longest / spacing), 1., double(kMostParts)));
      const Vec3f normal(normalized(across));
      const auto area = float(.5 * length(across) / (double(n) * n));
      if (!(area > 0)) continue;
      divide(p, n, [&](const Vec3d& at) { points.push_back({Vec3f(at), normal, area, 0}); });
    }
  }
  const NearestSample nearest(samples, &world);
  parallel_chunks(points.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      points[i].sample = nearest.at(points[i].position, points[i].normal);
  });
  std::vector<double> area(samples.size());
  for (const BoundaryPoint& point : points) area[point.sample] += double(point.area);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    if (area[i] > 0) continue;  // else no point has come to lie in its cell
    const SurfaceSample& s = samples[i];
    const Vec3f normal = surface_point(world.meshes[s.mesh], s.triangle, s.u, s.v).geometric;
    points.push_back({s.position, normal, s.area, i});
    area[i] = double(s.area);
  }
  for (BoundaryPoint& point : points)
    point.area = float(double(point.area) * double(samples[point.sample].area) / area[point.sample]);
  return points;
}

}  // namespace opaline
