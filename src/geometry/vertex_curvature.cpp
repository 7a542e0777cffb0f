// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/vertex_curvature.h"

#include <algorithm>
#include <cmath>

#include "geometry/source_mesh.h"

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

double squared_edge(const Mesh& mesh, const Triangle& triangle, std::size_t opposite) {
  const Vec3d edge =
      mesh.positions[triangle[(opposite + 2) % 3]] - mesh.positions[triangle[(opposite + 1) % 3]];
  return dot(edge, edge);
}

/// Averages of vertices and their neighbours: kept x value + moved x sum of weighted neighbours.
struct Averages {
  std::vector<std::array<float, 3>> weights;  // edges opposite to the corners of each triangle
  std::vector<float> kept, moved;             // one per vertex
};

// Weights of the cotangent Laplacian: it moves no linear function, so coarse and fine sides of a vertex balance. Steps have one
// variance everywhere, less between the smallest triangles.
Averages averages_over_edges(const Mesh& mesh, double variance) {
  constexpr double kMostMoved = .75;
  Averages averages;
  averages.weights.reserve(mesh.triangles.size());
  std::vector<double> sums(mesh.positions.size()), squares(mesh.positions.size());
  for (const Triangle& triangle : mesh.triangles) {
    std::array<float, 3>& weights = averages.weights.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d u = mesh.positions[triangle[(k + 1) % 3]] - mesh.positions[triangle[k]],
                  v = mesh.positions[triangle[(k + 2) % 3]] - mesh.positions[triangle[k]];
      const double area = length(cross(u, v)), square = squared_edge(mesh, triangle, k);
      const double cotangent = area > 0 ? std::max(0., dot(u, v) / area) : 0;
      weights[k] = float(cotangent);
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) {
        sums[triangle[other]] += cotangent;
        squares[triangle[other]] += cotangent * square;
      }
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double moved = squares[i] > 0 ? std::min(kMostMoved, 2 * variance * sums[i] / squares[i]) : 0;
    averages.kept.push_back(float(1 - moved));
    averages.moved.push_back(sums[i] > 0 ? float(moved / sums[i]) : 0);
  }
  return averages;
}

}  // namespace

// Each step diffuses the normals by the cotangent Laplacian and adds a quarter of the mean squared edge to the variance.
std::vector<Vec3f> blurred_normals(const Mesh& mesh, double deviation) {
  constexpr double kMostSteps = 64;
  std::vector<Vec3f> normals = mesh.normals;
  double squares = 0;
  for (const Triangle& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) squares += squared_edge(mesh, triangle, k);
  if (normals.empty() || !(squares > 0)) return normals;
  const double variance_of_step = squares / (3 * double(mesh.triangles.size())) / 4;
  const int steps = int(std::min(kMostSteps, std::round(deviation * deviation / variance_of_step)));
  if (steps == 0) return normals;
  const Averages averages = averages_over_edges(mesh, variance_of_step);
  std::vector<Vec3f> sums(normals.size());
  for (int step = 0; step < steps; ++step) {
    std::ranges::fill(sums, Vec3f());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const auto& [of_a, of_b, of_c] = averages.weights[t];
      const Vec3f at_a = normals[a], at_b = normals[b], at_c = normals[c];
      sums[a] += at_b * of_c + at_c * of_b;
      sums[b] += at_c * of_a + at_a * of_c;
      sums[c] += at_a * of_b + at_b * of_a;
    }
    for (std::size_t i = 0; i < normals.size(); ++i)
      normals[i] = normalized(normals[i] * averages.kept[i] + sums[i] * averages.moved[i]);
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
