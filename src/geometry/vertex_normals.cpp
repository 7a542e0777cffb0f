// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/vertex_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/creases.h"
#include "geometry/oriented_point.h"
#include "geometry/topology.h"

namespace opaline {
namespace {

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
