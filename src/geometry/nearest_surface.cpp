// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/geometry/nearest_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "geometry/embree_handles.h"
#include "opaline/core/error.h"
#include "opaline/core/parallel.h"

namespace opaline {
namespace {

/// Of a point of a triangle, the weights of its second and third corner, and its squared distance.
struct OnTriangle {
  double u, v, square;
};

OnTriangle at(const Vec3d& from_corner, const Vec3d& ab, const Vec3d& ac, double u, double v) {
  const Vec3d apart = from_corner - ab * u - ac * v;
  return {u, v, dot(apart, apart)};
}

/// The foot of the perpendicular where it lies in the triangle, else the nearest point of the three sides.
OnTriangle nearest_on(const std::array<Vec3d, 3>& corners, const Vec3d& position) {
  const Vec3d p = position - corners[0], ab = corners[1] - corners[0], ac = corners[2] - corners[0],
              bc = ac - ab;
  const double bb = dot(ab, ab), cc = dot(ac, ac), b_c = dot(ab, ac), along_b = dot(p, ab),
               along_c = dot(p, ac), determinant = bb * cc - b_c * b_c;
  const double u = (along_b * cc - along_c * b_c) / determinant,
               v = (along_c * bb - along_b * b_c) / determinant;
  if (u >= 0 && v >= 0 && u + v <= 1) return at(p, ab, ac, u, v);
  const auto along = [](double projection, double square) {
    return square > 0 ? std::clamp(projection / square, 0., 1.) : 0;
  };
  const double on_bc = along(dot(p - ab, bc), dot(bc, bc));
  return std::min({at(p, ab, ac, along(along_b, bb), 0), at(p, ab, ac, 0, along(along_c, cc)),
                   at(p, ab, ac, 1 - on_bc, on_bc)},
                  [](const OnTriangle& a, const OnTriangle& b) { return a.square < b.square; });
}

}  // namespace

NearestSurface::NearestSurface(const RayScene& rays, std::span<const std::uint32_t> meshes)
    : rays_(rays), is_body_(rays.meshes_.size()) {
  for (const std::uint32_t m : meshes) is_body_[m] = true;
}

NearestSurface::Place NearestSurface::at(const Vec3d& position) const {
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  struct Search {
    const std::vector<RayScene::MeshView>& meshes;
    const std::vector<bool>& is_body;
    Vec3d position;
    double square;
    Place found{RTC_INVALID_GEOMETRY_ID, RTC_INVALID_GEOMETRY_ID, 0, 0, 0};
  } search{rays_.meshes_, is_body_, position, kAnywhere};
  const auto visit = [](RTCPointQueryFunctionArguments* candidate) {
    constexpr double kWider = 1 + 1e-5;  // so that no triangle is passed over that is as near
    Search& to = *static_cast<Search*>(candidate->userPtr);
    const std::uint32_t mesh = candidate->geomID, triangle = candidate->primID;
    if (!to.is_body[mesh]) return false;
    std::array<Vec3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = Vec3d(to.meshes[mesh].vertices[to.meshes[mesh].triangles[triangle][k]].position);
    const OnTriangle nearest = nearest_on(corners, to.position);
    if (std::tie(nearest.square, mesh, triangle) >= std::tie(to.square, to.found.mesh, to.found.triangle))
      return false;
    to.square = nearest.square;
    to.found = {mesh, triangle, float(nearest.u), float(nearest.v), std::sqrt(nearest.square)};
    candidate->query->radius = float(to.found.distance * kWider);
    return true;
  };
  const FlushDenormals mode;
  const Vec3f at(position);
  RTCPointQuery query{at.x, at.y, at.z, 0, float(kAnywhere)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(rays_.handles_->scene, &query, &context, visit, &search);
  require(search.found.mesh != RTC_INVALID_GEOMETRY_ID, "a point has a nearest one on the surface");
  return search.found;
}

}  // namespace opaline
