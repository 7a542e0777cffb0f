// SPDX-License-Identifier: GPL-3.0-or-later
#include "irradiance/cell_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/random.h"

namespace opaline {
namespace {

// A sample's triangle, and the map from its plane to barycentrics.
class OwnTriangle {
 public:
  OwnTriangle(const RayScene& rays, const SurfaceSample& s) : hit_{} {
    const Vec3f a = rays.surface_point(s.mesh, s.triangle, 0, 0).position;
    const Vec3f ab = rays.surface_point(s.mesh, s.triangle, 1, 0).position - a,
                ac = rays.surface_point(s.mesh, s.triangle, 0, 1).position - a, normal = cross(ab, ac);
    const float scale = 1 / dot(normal, normal);
    along_u_ = cross(ac, normal) * scale;
    along_v_ = cross(normal, ab) * scale;
    hit_.mesh = s.mesh;
    hit_.triangle = s.triangle;
    hit_.u = s.u;
    hit_.v = s.v;
  }

  /// Point at d from the sample as a hit, Hit::kMiss outside the triangle.
  Hit at(const Vec3f& d) const {
    Hit hit = hit_;
    hit.u += dot(d, along_u_);
    hit.v += dot(d, along_v_);
    if (!(hit.u >= 0 && hit.v >= 0 && hit.u + hit.v <= 1)) hit.mesh = Hit::kMiss;
    return hit;
  }

 private:
  Hit hit_;
  Vec3f along_u_, along_v_;  // u and v of d are its products with these
};

}  // namespace

std::vector<bool> meshes_of(std::span<const SurfaceSample> samples) {
  std::vector<bool> meshes;
  for (const SurfaceSample& s : samples) {
    if (s.mesh >= meshes.size()) meshes.resize(s.mesh + 1);
    meshes[s.mesh] = true;
  }
  return meshes;
}

CellPoints::CellPoints(const RayScene& rays, std::span<const SurfaceSample> samples,
                       const std::vector<bool>& surface, float spacing)
    : rays_(rays), samples_(samples), surface_(surface), radius_(0.85f * spacing) {}

std::uint32_t CellPoints::add(std::uint32_t index, std::span<const std::uint32_t> neighbours) {
  // About one candidate in three is in the cell; cells of slivers have fewer lines.
  constexpr std::uint64_t kCandidates = 8 * kMost;
  const SurfaceSample& s = samples_[index];
  const Vec3f normal = rays_.surface_point(s.mesh, s.triangle, s.u, s.v).geometric;
  Vec3f x, y;
  tangent_frame(normal, x, y);
  const OwnTriangle own(rays_, s);
  const std::size_t first_bisector = bisectors_.size();
  for (const std::uint32_t j : neighbours) {
    const Vec3f away = samples_[j].position - s.position;
    bisectors_.push_back({away, dot(away, away) / 2});
  }
  cells_.push_back({s.position, normal, s.mesh, s.triangle, first_bisector, bisectors_.size()});
  const std::array<double, 2> shift = {unit_double(hash_bits(0, 2 * std::uint64_t(index))),
                                       unit_double(hash_bits(0, 2 * std::uint64_t(index) + 1))};
  const auto number = std::uint32_t(cells_.size() - 1);
  std::uint32_t count = 0;
  for (std::uint64_t k = 0; k < kCandidates && count < kMost; ++k) {
    const auto [u, v] = r2_point(k, shift);
    const Vec3f d = x * (radius_ * float(2 * u - 1)) + y * (radius_ * float(2 * v - 1));
    const float height2 = radius_ * radius_ - dot(d, d);
    if (!(height2 > 0) || !is_within(cells_.back(), d)) continue;
    const float height = std::sqrt(height2);
    lines_.push_back({number, count++, Ray(s.position + d + normal * height, -normal, 2 * height)});
    // Tests the sample's own triangle directly: rays could hit a coplanar shape instead.
    const Hit hit = own.at(d);
    if (hit.mesh != Hit::kMiss)
      add_crossing(lines_.back(), rays_.surface_point(hit.mesh, hit.triangle, hit.u, hit.v));
  }
  return number;
}

bool CellPoints::is_within(const Cell& cell, const Vec3f& from_sample) const {
  for (std::size_t b = cell.first_bisector; b < cell.end_bisector; ++b)
    if (dot(from_sample, bisectors_[b].away) > bisectors_[b].half2) return false;
  return true;
}

void CellPoints::project() {
  constexpr int kSheets = 16;  // maximum sheets along a line
  std::vector<TracedRay> traced;
  for (const Line& line : lines_) traced.push_back({line.ray, {}});
  std::vector<std::uint32_t> open(lines_.size());
  std::iota(open.begin(), open.end(), 0u);
  for (int sheet = 0; sheet < kSheets && !open.empty(); ++sheet) {
    rays_.intersect(traced);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < traced.size(); ++i) {
      const auto& [ray, hit] = traced[i];
      if (hit.mesh == Hit::kMiss) continue;
      const Line& line = lines_[open[i]];
      const SurfacePoint point = rays_.surface_point(hit.mesh, hit.triangle, hit.u, hit.v);
      const Cell& cell = cells_[line.cell];
      const bool is_known = hit.mesh == cell.mesh && hit.triangle == cell.triangle;
      if (is_own_mesh(hit.mesh) && !is_known) add_crossing(line, point);
      TracedRay next{line.ray, {}};
      next.ray.near = ray.far + rays_.offset(point);
      open[kept] = open[i];
      traced[kept++] = next;
    }
    open.resize(kept);
    traced.resize(kept);
  }
  sort_by_cell();
}

void CellPoints::add_crossing(const Line& line, const SurfacePoint& point) {
  constexpr float kSteepest = 0.1f;
  const Cell& cell = cells_[line.cell];
  const float cosine = dot(point.geometric, cell.normal);
  if (!(cosine > 0) || !is_within(cell, point.position - cell.sample)) return;
  // Steep surfaces are crossed by fewer lines per area.
  crossings_.push_back({line.cell, {point, 1 / std::max(cosine, kSteepest), line.number}});
}

void CellPoints::sort_by_cell() {
  first_.assign(cells_.size() + 1, 0);
  for (const auto& [cell, point] : crossings_) ++first_[cell + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::ranges::stable_sort(crossings_, {}, [](const auto& c) { return std::pair(c.first, c.second.line); });
  points_.clear();
  for (const auto& [cell, point] : crossings_) points_.push_back(point);
}

}  // namespace opaline
