// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/nearest_surface.h"

#include <cmath>
#include <limits>
#include <tuple>

#include "core/parallel.h"
#include "geometry/embree_handles.h"
#include "geometry/nearest_on_triangle.h"
#include "opaline/error.h"

namespace opaline {
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
    constexpr double kWider = 1 + 1e-5;  // margin keeping all equally near triangles
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
