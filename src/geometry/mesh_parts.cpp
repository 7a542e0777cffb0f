// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/winding_number.h"

namespace opaline {
namespace {

using Kind = MeshParts::Kind;

/// Six times the volume of the tetrahedron below the triangle.
double signed_volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& origin) {
  return dot(a - origin, cross(b - origin, c - origin));
}

/// For each rim edge the first edge of its rim: of the same part, and connected.
std::vector<std::uint32_t> rims_of(std::span<const MeshParts::RimEdge> edges) {
  std::vector<std::uint32_t> parent(edges.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t e) {
    while (parent[e] != e) e = parent[e] = parent[parent[e]];
    return e;
  };
  std::vector<std::uint32_t> by_end(2 * edges.size());  // edge 2 e at its start, 2 e + 1 at its end
  std::iota(by_end.begin(), by_end.end(), 0u);
  const auto end = [&](std::uint32_t i) {
    const MeshParts::RimEdge& edge = edges[i / 2];
    return std::pair(edge.part, i % 2 == 0 ? edge.from : edge.to);
  };
  std::ranges::sort(by_end, {}, [&](std::uint32_t i) { return std::pair(end(i), i); });
  for (std::size_t i = 1; i < by_end.size(); ++i) {
    if (end(by_end[i]) != end(by_end[i - 1])) continue;
    const auto [low, high] = std::minmax({root(by_end[i] / 2), root(by_end[i - 1] / 2)});
    parent[high] = low;
  }
  for (std::uint32_t e = 0; e < parent.size(); ++e) parent[e] = root(e);
  return parent;
}

}  // namespace

MeasuredParts::MeasuredParts(const WoundMesh& mesh, const MeshParts& parts)
    : mesh_(mesh), parts_(parts), measures_(parts.kinds.size()) {
  group_triangles();
  close_holes();
  for (std::size_t part = 0; part < measures_.size(); ++part) {
    if (parts.kinds[part] == Kind::ignored) continue;
    if (parts.kinds[part] == Kind::open) measure_areas(part);
    measure_volume(part);
  }
}

MeasuredParts::Corners MeasuredParts::corners(std::size_t t) const {
  const auto& [a, b, c] = mesh_.triangles[t];
  return {mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]};
}

std::span<const std::uint32_t> MeasuredParts::triangles(std::size_t part) const {
  return std::span(order_).subspan(first_[part], first_[part + 1] - first_[part]);
}

std::span<const MeasuredParts::Corners> MeasuredParts::closing(std::size_t part) const {
  return std::span(closing_).subspan(first_closing_[part], first_closing_[part + 1] - first_closing_[part]);
}

void MeasuredParts::group_triangles() {
  first_.resize(measures_.size() + 1);
  for (const std::uint32_t part : parts_.of) ++first_[part + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  order_.resize(parts_.of.size());
  for (std::uint32_t t = 0; t < order_.size(); ++t) order_[next[parts_.of[t]]++] = t;
}

/// Each rim is joined to the middle of its edges.
void MeasuredParts::close_holes() {
  const std::vector<MeshParts::RimEdge>& edges = parts_.rims;
  first_closing_.resize(measures_.size() + 1);
  for (const MeshParts::RimEdge& edge : edges) ++first_closing_[edge.part + 1];
  std::partial_sum(first_closing_.begin(), first_closing_.end(), first_closing_.begin());
  const std::vector<std::uint32_t> rim = rims_of(edges);
  std::vector<Vec3d> sum(edges.size());
  std::vector<double> weight(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Vec3d &from = mesh_.positions[edges[e].from], &to = mesh_.positions[edges[e].to];
    sum[rim[e]] += (from + to) * (length(to - from) / 2);
    weight[rim[e]] += length(to - from);
  }
  std::vector<std::uint32_t> next(first_closing_.begin(), first_closing_.end() - 1);
  closing_.resize(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Vec3d &from = mesh_.positions[edges[e].from], &to = mesh_.positions[edges[e].to];
    const double rim_length = weight[rim[e]];
    const Vec3d middle = rim_length > 0 ? sum[rim[e]] / rim_length : from;
    closing_[next[edges[e].part]++] = {to, from, middle};
  }
}

void MeasuredParts::measure_areas(std::size_t part) {
  PartMeasures& measures = measures_[part];
  for (const std::uint32_t t : triangles(part)) {
    const auto [a, b, c] = corners(t);
    const Vec3d vector = cross(b - a, c - a);
    const double area = length(vector);
    measures.area += area;
    measures.area_vector += vector;
    if (mesh_.normals.empty()) continue;
    for (const std::uint32_t v : mesh_.triangles[t]) {
      const Vec3d normal(mesh_.normals[v]);
      const double along = dot(vector, normal), clear = 1e-3 * area * length(normal);
      if (along > clear) measures.area_for_normals += area / 3;
      if (along < -clear) measures.area_against_normals += area / 3;
    }
  }
  for (const auto& [a, b, c] : closing(part)) measures.hole_area += length(cross(b - a, c - a));
}

void MeasuredParts::measure_volume(std::size_t part) {
  PartMeasures& measures = measures_[part];
  for (const std::uint32_t t : triangles(part)) {
    const auto [a, b, c] = corners(t);
    for (const Vec3d* p : {&a, &b, &c}) widen(measures.box.low, measures.box.high, *p);
  }
  const Vec3d origin = parts_.kinds[part] == Kind::open ? .5 * (measures.box.low + measures.box.high)
                                                        : corners(triangles(part)[0]).a;
  const auto add = [&](const Corners& triangle) {
    const double volume = signed_volume(triangle.a, triangle.b, triangle.c, origin);
    measures.volume += volume;
    measures.magnitudes += std::abs(volume);
  };
  for (const std::uint32_t t : triangles(part)) add(corners(t));
  for (const Corners& triangle : closing(part)) add(triangle);
}

bool MeasuredParts::contains(std::size_t outer, std::size_t inner) const {
  const std::span<const std::uint32_t> own = triangles(inner);
  if (parts_.kinds[inner] == Kind::closed) return contains_point(outer, corners(own[0]).a);
  constexpr std::size_t kPoints = 9;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const auto [a, b, c] = corners(own[(2 * i + 1) * own.size() / (2 * kPoints)]);
    inside += contains_point(outer, (a + b + c) / 3.);
  }
  return inside > kPoints / 2;
}

/// By the winding number: the solid angle of the whole part seen from the point.
bool MeasuredParts::contains_point(std::size_t outer, const Vec3d& point) const {
  double angle = 0;
  const auto add = [&](const Corners& triangle) {
    angle += solid_angle(triangle.a - point, triangle.b - point, triangle.c - point);
  };
  for (const std::uint32_t t : triangles(outer)) add(corners(t));
  for (const Corners& triangle : closing(outer)) add(triangle);
  constexpr double half_sphere = 6.283185307179586;
  return std::abs(angle) > half_sphere;
}

PartMeasures MeasuredParts::common_measures(std::span<const std::uint32_t> parts) const {
  PartMeasures common;
  Vec3d middle;
  for (const std::uint32_t part : parts) {
    common.area += measures_[part].area;
    common.area_vector += measures_[part].area_vector;
    for (const std::uint32_t t : triangles(part)) {
      const auto [a, b, c] = corners(t);
      middle += (a + b + c) * (length(cross(b - a, c - a)) / 3);
    }
  }
  if (common.area > 0) middle = middle / common.area;
  for (const std::uint32_t part : parts)
    for (const std::uint32_t t : triangles(part)) {
      const auto [a, b, c] = corners(t);
      const double volume = signed_volume(a, b, c, middle);
      common.volume += volume;
      common.magnitudes += std::abs(volume);
    }
  return common;
}

}  // namespace opaline
