// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/vertex_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "geometry/oriented_point.h"
#include "geometry/source_mesh.h"
#include "geometry/topology.h"

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

/// Gives each vertex without a normal the average over the triangles around it up to the creases, weighted by
/// angle. A vertex on a crease becomes one vertex per side, the new ones after all others. A crease is an
/// edge between triangles of different smoothing groups or of none, or with a bend above the crease angle.
/// in    mesh.normals: one per vertex; missing: flags of the vertices to complete; every triangle has an area
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

/// Twice the triangle's area, along its normal.
Vec3d area_vector(const Mesh& mesh, const Triangle& t) {
  const Vec3d& a = mesh.positions[t[0]];
  return cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
}

/// out   triangles facing opposite to around(v), of any length, at each of their vertices v
template <class Around>
std::vector<std::uint32_t> triangles_against(const Mesh& mesh, const Around& around) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3d area = area_vector(mesh, mesh.triangles[i]);
    const auto faces_against = [&](std::uint32_t v) {
      const Vec3d outward(around(v));
      return dot(area, outward) < 0 && dot(normalized(area), normalized(outward)) < double(kReversed);
    };
    if (std::ranges::all_of(mesh.triangles[i], faces_against)) found.push_back(i);
  }
  return found;
}

/// Triangles reversed by a fold. The sum of the area vectors around a vertex depends only on its one-ring, so
/// it is independent of the vertex's own displacement.
template <class SiteOf>
std::vector<std::uint32_t> reversed_by_areas(const Mesh& mesh, const SiteOf& site_of) {
  std::vector<Vec3d> sums(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d area = area_vector(mesh, t);
    for (const std::uint32_t v : t) sums[site_of(v)] += area;
  }
  return triangles_against(mesh, [&](std::uint32_t v) { return sums[site_of(v)]; });
}

/// One average for all vertices at the same position, without triangles reversed by a fold.
std::vector<Vec3d> averages(const Mesh& mesh, const std::vector<std::uint32_t>& site) {
  std::vector<Vec3d> sum(mesh.positions.size());
  const auto add = [&](const Triangle& t, double sign) {
    const Vec3d normal = unit_normal(mesh, t);
    for (std::size_t k = 0; k < 3; ++k) sum[site[t[k]]] += normal * (sign * corner_angle(mesh, t, k));
  };
  for (const Triangle& t : mesh.triangles) add(t, 1);
  for (const std::uint32_t t : reversed_by_areas(mesh, [&](std::uint32_t v) { return site[v]; }))
    add(mesh.triangles[t], -1);
  return sum;
}

/// Vertices with a zero sum of normals get the normal of one triangle.
void average_missing(Mesh& mesh, const std::vector<bool>& missing, bool all_apart) {
  std::vector<std::uint32_t> site(all_apart ? mesh.positions.size() : 0);
  std::iota(site.begin(), site.end(), 0u);
  if (!all_apart) site = weld(mesh.positions);
  const std::vector<Vec3d> sum = averages(mesh, site);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (!missing[v]) continue;
      const Vec3d& average = sum[site[v]];
      mesh.normals[v] = Vec3f(length(average) > 1e-6 ? normalized(average) : unit_normal(mesh, t));
    }
  }
}

/// Flips normals left unchanged when a mesh was turned inside out.
std::size_t turn_outward(Mesh& mesh) {
  std::vector<double> agreement(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d normal = unit_normal(mesh, t);
    for (const std::uint32_t v : t) agreement[v] += dot(normal, Vec3d(mesh.normals[v]));
  }
  std::size_t turned = 0;
  for (std::size_t v = 0; v < agreement.size(); ++v) {
    if (agreement[v] >= 0) continue;
    mesh.normals[v] = -mesh.normals[v];
    ++turned;
  }
  for (std::size_t t = 0; t < mesh.tangents.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (agreement[mesh.triangles[t][k]] < 0) mesh.tangents[t][k].side *= -1;
  return turned;
}

}  // namespace

Vec3d unit_normal(const Mesh& mesh, const Triangle& t) {
  return normalized(area_vector(mesh, t));
}

double corner_angle(const Mesh& mesh, const Triangle& t, std::size_t k) {
  const Vec3d& corner = mesh.positions[t[k]];
  const Vec3d u = mesh.positions[t[(k + 1) % 3]] - corner, v = mesh.positions[t[(k + 2) % 3]] - corner;
  return std::atan2(length(cross(u, v)), dot(u, v));
}

std::vector<std::uint32_t> reversed_triangles(const Mesh& mesh) {
  if (mesh.normals.empty()) return reversed_by_areas(mesh, [](std::uint32_t v) { return v; });
  return triangles_against(mesh, [&](std::uint32_t v) { return mesh.normals[v]; });
}

void complete_normals(Mesh& mesh, const Smoothing& smoothing, const std::string& name,
                      std::vector<std::string>& warnings) {
  const bool own = !mesh.normals.empty();
  mesh.normals.resize(mesh.positions.size());
  std::vector<bool> missing(mesh.positions.size());
  std::size_t count = 0;
  for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
    const Vec3d unit = normalized(Vec3d(mesh.normals[v]));  // in double: the square of a small float is zero
    mesh.normals[v] = Vec3f(unit);
    missing[v] = unit == Vec3d();
    count += missing[v];
  }
  if (count > 0 && smoothing.is_everywhere())
    average_missing(mesh, missing, !own);
  else if (count > 0)
    average_between_creases(mesh, missing, smoothing);
  if (!own) return;
  if (count > 0)
    warnings.push_back(name + ": " + std::to_string(count) +
                       " vertices without a usable normal; normals computed");
  const std::size_t turned = turn_outward(mesh);
  if (turned > 0)
    warnings.push_back(name + ": " + std::to_string(turned) +
                       " normals pointed into the surface and were flipped");
}
}  // namespace opaline
