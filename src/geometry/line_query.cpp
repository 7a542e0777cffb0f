// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/geometry/line_query.h"

#include <algorithm>

#include "geometry/embree_handles.h"
#include "opaline/core/parallel.h"

namespace opaline {

struct LineQuery::Handle {
  RTCScene scene = nullptr;
  ~Handle() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
};

namespace {

struct CollectingContext {
  RTCIntersectContext context;  // first: Embree passes it on
  std::vector<Hit>* crossings;
};

// Notes the hit and refuses it, so that the traversal goes on. Embree may offer a triangle twice.
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
  rtcSetSceneFlags(handle_->scene,
                   RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
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
  rtcInitIntersectContext(&context.context);
  context.context.filter = collect;
  context.crossings = &crossings;
  TracedRay traced{ray, {}};
  rtcIntersect1(handle_->scene, &context.context, reinterpret_cast<RTCRayHit*>(&traced));
}

}  // namespace opaline
