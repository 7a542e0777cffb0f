// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/creases.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "geometry/topology.h"
#include "geometry/vertex_normals.h"

namespace opaline {
namespace {

/// Sets of triangle corners at one position not separated by creases. Corner 3 t + k belongs to triangle t.
class Fans {
 public:
  Fans(const Mesh& mesh, const Smoothing& smoothing)
      : smoothing_(smoothing),
        least_cosine_(std::cos(smoothing.crease_angle * std::numbers::pi / 180) - kRounding),
        parent_(3 * mesh.triangles.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    normals_.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) normals_.push_back(unit_normal(mesh, t));
    const std::vector<std::uint32_t> site = weld(mesh.positions);
    std::vector<Triangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) triangles.push_back({site[a], site[b], site[c]});
    const EdgeTable edges(triangles, mesh.positions.size());
    edges.for_each([&](std::uint32_t, std::uint32_t, std::span<const std::uint32_t> corners) {
      for (const std::uint32_t corner : corners.subspan(1)) join(triangles, corners[0], corner);
    });
  }

  /// The first corner of a corner's fan.
  std::uint32_t first(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }

  const Vec3d& normal(std::size_t triangle) const { return normals_[triangle]; }

 private:
  static constexpr double kRounding = 1e-9;

  bool is_crease(std::uint32_t t, std::uint32_t u) const {
    const auto& groups = smoothing_.groups;
    if (!groups.empty() && (groups[t] == 0 || groups[t] != groups[u])) return true;
    return dot(normals_[t], normals_[u]) < least_cosine_;
  }

  /// Joins the fans at both ends of an edge of two triangles starting at these corners.
  void join(const std::vector<Triangle>& triangles, std::uint32_t a, std::uint32_t b) {
    if (is_crease(a / 3, b / 3)) return;
    const bool same_way = triangles[a / 3][a % 3] == triangles[b / 3][b % 3];
    unite(a, same_way ? b : next(b));
    unite(next(a), same_way ? next(b) : b);
  }

  static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

  void unite(std::uint32_t a, std::uint32_t b) {
    a = first(a), b = first(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  const Smoothing& smoothing_;
  double least_cosine_;
  std::vector<std::uint32_t> parent_;
  std::vector<Vec3d> normals_;  // normals of the triangles
};

}  // namespace

void average_between_creases(Mesh& mesh, const std::vector<bool>& missing, const Smoothing& smoothing) {
  constexpr std::uint32_t none = ~0u;
  Fans fans(mesh, smoothing);
  std::vector<Vec3d> sum(3 * mesh.triangles.size());  // sum of fans
  const auto for_each_corner = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) visit(t, k, fans.first(3 * t + k));
  };
  for_each_corner([&](std::uint32_t t, std::uint32_t k, std::uint32_t fan) {
    sum[fan] += fans.normal(t) * corner_angle(mesh, mesh.triangles[t], k);
  });
  std::vector<std::uint32_t> vertex(sum.size(), none);  // vertex of each fan
  std::vector<bool> is_taken(missing.size());
  for_each_corner([&](std::uint32_t t, std::uint32_t k, std::uint32_t fan) {
    std::uint32_t& own = mesh.triangles[t][k];
    if (!missing[own]) return;
    if (vertex[fan] == none && !is_taken[own]) {
      vertex[fan] = own;
      is_taken[own] = true;
    } else if (vertex[fan] == none) {
      vertex[fan] = std::uint32_t(mesh.positions.size());
      mesh.positions.push_back(mesh.positions[own]);
      mesh.normals.emplace_back();
    }
    own = vertex[fan];
    mesh.normals[own] = Vec3f(length(sum[fan]) > 1e-6 ? normalized(sum[fan]) : fans.normal(t));
  });
}

}  // namespace opaline
