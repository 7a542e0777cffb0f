// SPDX-License-Identifier: GPL-3.0-or-later
#include "irradiance/cell_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "opaline/core/random.h"

namespace opaline {
namespace {

// A bisector between a sample and a neighbour: a point at d from the sample is the neighbour's if d . away >
// half2.
struct Bisector {
  Vec3f away;
  float half2;
};

std::vector<Bisector> bisectors(const Vec3f& p, std::span<const SurfaceSample> samples,
                                std::span<const std::uint32_t> neighbours) {
  std::vector<Bisector> all;
  for (const std::uint32_t j : neighbours) {
    const Vec3f away = samples[j].position - p;
    all.push_back({away, dot(away, away) / 2});
  }
  return all;
}

// A sample's triangle, and places on it from places in its plane.
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

  /// The place at d from the sample as a hit, of Hit::kMiss where it is outside.
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

CellPoints::Range CellPoints::add(std::uint32_t index, std::span<const std::uint32_t> neighbours) {
  // About one candidate in three lies in the cell; a sliver's cell makes do with fewer points.
  constexpr std::uint64_t kCandidates = 8 * kMost;
  const SurfaceSample& s = samples_[index];
  const Vec3f normal = rays_.surface_point(s.mesh, s.triangle, s.u, s.v).geometric;
  Vec3f x, y;
  tangent_frame(normal, x, y);
  const std::vector<Bisector> sides = bisectors(s.position, samples_, neighbours);
  const OwnTriangle own(rays_, s);
  const std::array<double, 2> shift = {unit_double(hash_bits(0, 2 * std::uint64_t(index))),
                                       unit_double(hash_bits(0, 2 * std::uint64_t(index) + 1))};
  Range range{std::uint32_t(traced_.size()), 0};
  for (std::uint64_t k = 0; k < kCandidates && range.count < kMost; ++k) {
    const auto [u, v] = r2_point(k, shift);
    const Vec3f d = x * (radius_ * float(2 * u - 1)) + y * (radius_ * float(2 * v - 1));
    const float distance2 = dot(d, d);
    if (distance2 > radius_ * radius_) continue;
    if (std::ranges::any_of(sides, [&](const Bisector& b) { return dot(d, b.away) > b.half2; })) continue;
    const Hit on_own = own.at(d);
    // No ray finds the own triangle more surely; Embree leaves rays that end before they begin alone.
    const float distance = std::sqrt(distance2), end = on_own.mesh == Hit::kMiss ? 2 * distance : -1;
    traced_.push_back({Ray(s.position + d + normal * distance, -normal, end), on_own});
    lengths_.push_back(end);
    ++range.count;
  }
  return range;
}

void CellPoints::project() {
  rays_.intersect(traced_);
  look_behind_other_meshes();
  points_.resize(traced_.size());
  found_.resize(traced_.size());
  for (std::size_t i = 0; i < traced_.size(); ++i) {
    const auto& [ray, hit] = traced_[i];
    if (!is_own_mesh(hit.mesh)) continue;
    points_[i] = rays_.surface_point(hit.mesh, hit.triangle, hit.u, hit.v);
    found_[i] = dot(points_[i].geometric, ray.direction) < 0;
  }
}

// Something that stands on the surface hides it from above: rays that met it go on once more.
void CellPoints::look_behind_other_meshes() {
  std::vector<std::size_t> again;
  std::vector<TracedRay> rays;
  for (std::size_t i = 0; i < traced_.size(); ++i) {
    const auto& [ray, hit] = traced_[i];
    if (hit.mesh == Hit::kMiss || is_own_mesh(hit.mesh)) continue;
    again.push_back(i);
    rays.push_back({Ray(ray.origin, ray.direction, lengths_[i]), {}});
    rays.back().ray.near = ray.far * 1.0001f;
  }
  rays_.intersect(rays);
  for (std::size_t i = 0; i < again.size(); ++i) traced_[again[i]] = rays[i];
}

}  // namespace opaline
