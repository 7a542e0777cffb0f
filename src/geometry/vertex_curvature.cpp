// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/vertex_curvature.h"

#include <algorithm>
#include <cmath>

namespace opaline {
namespace {

/// Half the trace of the second fundamental form of a triangle, by least squares over the changes of normals along
/// its edges: unknowns a, b, c of [a b; b c].
double mean_curvature_of(const std::array<Vec3d, 3>& corners, const std::array<Vec3d, 3>& normals) {
  const Vec3d u = normalized(corners[1] - corners[0]),
              across = cross(corners[1] - corners[0], corners[2] - corners[0]),
              v = normalized(cross(across, u));
  double uu = 0, uv = 0, vv = 0, right_a = 0, right_b = 0, right_c = 0;
  for (std::size_t e = 0; e < 3; ++e) {
    const Vec3d edge = corners[(e + 1) % 3] - corners[e], change = normals[(e + 1) % 3] - normals[e];
    const double x = dot(edge, u), y = dot(edge, v), along = dot(change, u), aside = dot(change, v);
    uu += x * x;
    uv += x * y;
    vv += y * y;
    right_a += x * along;
    right_b += y * along + x * aside;
    right_c += y * aside;
  }
  // Normal equations: [uu uv 0; uv uu+vv uv; 0 uv vv] (a, b, c) = right.
  const double determinant = (uu + vv) * (uu * vv - uv * uv);
  if (!(determinant > 0)) return 0;
  const double a = right_a * ((uu + vv) * vv - uv * uv) - right_b * uv * vv + right_c * uv * uv;
  const double c = right_a * uv * uv - right_b * uu * uv + right_c * (uu * (uu + vv) - uv * uv);
  return .5 * (a + c) / determinant;
}

}  // namespace

// Each step averages a vertex with its neighbours and adds a quarter of the squared edge to the variance.
std::vector<Vec3f> blurred_normals(const Mesh& mesh, double deviation) {
  constexpr double kMostSteps = 64;
  std::vector<Vec3f> normals = mesh.normals;
  double squares = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    for (const Vec3d& edge : {mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[b],
                              mesh.positions[a] - mesh.positions[c]})
      squares += dot(edge, edge);
  if (normals.empty() || !(squares > 0)) return normals;
  const double variance_of_step = squares / (3 * double(mesh.triangles.size())) / 4;
  const int steps = int(std::min(kMostSteps, std::round(deviation * deviation / variance_of_step)));
  std::vector<Vec3f> sums(normals.size());
  for (int step = 0; step < steps; ++step) {
    std::ranges::fill(sums, Vec3f());
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3f sum = normals[a] + normals[b] + normals[c];
      for (const std::uint32_t corner : {a, b, c}) sums[corner] += sum - normals[corner];
    }
    for (std::size_t i = 0; i < normals.size(); ++i)
      normals[i] = normalized(normals[i] + normalized(sums[i]));
  }
  return normals;
}

std::vector<float> mean_curvature(const Mesh& mesh, std::span<const Vec3f> normals) {
  if (normals.empty()) return {};
  std::vector<double> sums(mesh.positions.size()), weights(mesh.positions.size());
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    std::array<Vec3d, 3> corners, at_corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = mesh.positions[triangle[k]];
      at_corners[k] = Vec3d(normals[triangle[k]]);
    }
    const double area = length(cross(corners[1] - corners[0], corners[2] - corners[0]));
    const double curvature = mean_curvature_of(corners, at_corners);
    if (!(area > 0) || !std::isfinite(curvature)) continue;
    for (const std::uint32_t corner : triangle) {
      sums[corner] += area * curvature;
      weights[corner] += area;
    }
  }
  std::vector<float> curvatures(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (weights[i] > 0) curvatures[i] = float(sums[i] / weights[i]);
  return curvatures;
}

}  // namespace opaline
