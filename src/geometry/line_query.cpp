// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/line_query.h"

#include <algorithm>

#include "core/parallel.h"
#include "geometry/embree_handles.h"

namespace opaline {

struct LineQuery::Handle {
  RTCScene scene = nullptr;
  ~Handle() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
};

namespace {

struct CollectingContext {
  QueryContext context;  // first: Embree passes it on
  std::vector<Hit>* crossings;
};

// Records the hit and refuses it, so the traversal continues. Embree may report a triangle twice.
void collect(const RTCFilterFunctionNArguments* arguments) {
  std::vector<Hit>& crossings = *reinterpret_cast<CollectingContext*>(arguments->context)->crossings;
  const RTCHit found = rtcGetHitFromHitN(arguments->hit, arguments->N, 0);
  arguments->valid[0] = 0;
  const auto same = [&](const Hit& h) { return h.triangle == found.primID && h.mesh == found.geomID; };
  if (std::ranges::any_of(crossings, same)) return;
  Hit hit;
  hit.edges_cross = {found.Ng_x, found.Ng_y, found.Ng_z};
  hit.u = found.u;
  hit.v = found.v;
  hit.triangle = found.primID;
  hit.mesh = found.geomID;
  crossings.push_back(hit);
}

}  // namespace

LineQuery::LineQuery(const RayScene& rays, std::span<const std::uint32_t> meshes)
    : handle_(std::make_unique<Handle>()) {
  handle_->scene = rtcNewScene(rays.handles_->device);
  rtcSetSceneFlags(handle_->scene, RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | kAllowsHitFilter));
  for (const std::uint32_t mesh : meshes)
    rtcAttachGeometryByID(handle_->scene, rtcGetGeometry(rays.handles_->scene, mesh), mesh);
  rtcCommitScene(handle_->scene);
  check_device(rays.handles_->device);
}

LineQuery::~LineQuery() = default;
LineQuery::LineQuery(LineQuery&&) noexcept = default;

void LineQuery::find(const Ray& ray, std::vector<Hit>& crossings) const {
  const FlushDenormals mode;
  crossings.clear();
  CollectingContext context;
  context.crossings = &crossings;
  find_hits_with(collect, context.context, handle_->scene, ray);
}

std::vector<LineQuery::Triangle> LineQuery::triangles_in(const RayScene& rays, const Vec3f& low, float side) {
  struct Search {
    const std::vector<RayScene::MeshView>& meshes;
    Vec3f low, high;
    std::vector<std::uint64_t> found;
    std::array<Vec3f, 3> corners(std::uint32_t mesh, std::uint32_t triangle) const {
      const auto& [a, b, c] = meshes[mesh].triangles[triangle];
      const auto& vertices = meshes[mesh].vertices;
      return {vertices[a].position, vertices[b].position, vertices[c].position};
    }
  } search{rays.meshes_, low, low + Vec3f(side), {}};
  const auto collect = [](RTCPointQueryFunctionArguments* candidate) {
    Search& to = *static_cast<Search*>(candidate->userPtr);
    const auto [a, b, c] = to.corners(candidate->geomID, candidate->primID);
    if (min_component(component_max(a, component_max(b, c)) - to.low) >= 0 &&
        min_component(to.high - component_min(a, component_min(b, c))) >= 0)
      to.found.push_back(std::uint64_t(candidate->geomID) << 32 | candidate->primID);
    return false;  // the radius stays
  };
  const Vec3f middle = low + Vec3f(side / 2);
  constexpr float kHalfDiagonal = 0.8661f;
  RTCPointQuery query{middle.x, middle.y, middle.z, 0, side * kHalfDiagonal};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(rays.handles_->scene, &query, &context, collect, &search);
  std::ranges::sort(search.found);
  search.found.erase(std::unique(search.found.begin(), search.found.end()), search.found.end());
  std::vector<Triangle> triangles;
  triangles.reserve(search.found.size());
  for (const std::uint64_t id : search.found) {
    const auto mesh = std::uint32_t(id >> 32), triangle = std::uint32_t(id);
    triangles.push_back({mesh, triangle, search.corners(mesh, triangle)});
  }
  return triangles;
}

}  // namespace opaline
