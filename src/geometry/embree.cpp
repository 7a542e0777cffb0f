// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/embree.h"

#include <algorithm>

#if RTC_VERSION_MAJOR >= 4

namespace opaline {
namespace {

// Embree 4 has no ray streams: coherent rays are traced in packets.
constexpr std::size_t kPacket = 16;

struct alignas(64) Mask {
  int valid[kPacket];
  explicit Mask(std::size_t count) {
    for (std::size_t i = 0; i < kPacket; ++i) valid[i] = i < count ? -1 : 0;
  }
};

void copy_to(RTCRay16& packet, std::size_t i, const Ray& ray) {
  packet.org_x[i] = ray.origin.x, packet.org_y[i] = ray.origin.y, packet.org_z[i] = ray.origin.z;
  packet.dir_x[i] = ray.direction.x, packet.dir_y[i] = ray.direction.y, packet.dir_z[i] = ray.direction.z;
  packet.tnear[i] = ray.near, packet.tfar[i] = ray.far, packet.time[i] = ray.time;
  packet.mask[i] = ray.mask, packet.id[i] = ray.id, packet.flags[i] = ray.flags;
}

/// Empty for a miss.
void copy_from(const RTCHit16& packet, std::size_t i, Hit& hit) {
  if (packet.geomID[i] == RTC_INVALID_GEOMETRY_ID) return;
  hit.edges_cross = {packet.Ng_x[i], packet.Ng_y[i], packet.Ng_z[i]};
  hit.u = packet.u[i], hit.v = packet.v[i];
  hit.triangle = packet.primID[i], hit.mesh = packet.geomID[i], hit.instance = packet.instID[0][i];
}

RTCIntersectArguments coherent_hits() {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  return arguments;
}

RTCRayHit single(const Ray& ray) {
  RTCRayHit traced;
  traced.ray = *reinterpret_cast<const RTCRay*>(&ray);
  traced.hit.geomID = traced.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return traced;
}

}  // namespace

void find_hits(RTCScene scene, std::span<TracedRay> rays) {
  RTCIntersectArguments arguments = coherent_hits();
  for (std::size_t begin = 0; begin < rays.size(); begin += kPacket) {
    const std::span<TracedRay> part = rays.subspan(begin, std::min(kPacket, rays.size() - begin));
    const Mask mask(part.size());
    RTCRayHit16 packet{};
    for (std::size_t i = 0; i < part.size(); ++i) {
      copy_to(packet.ray, i, part[i].ray);
      packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(mask.valid, scene, &packet, &arguments);
    for (std::size_t i = 0; i < part.size(); ++i) {
      part[i].ray.far = packet.ray.tfar[i];
      copy_from(packet.hit, i, part[i].hit);
    }
  }
}

void find_hit(RTCScene scene, TracedRay& ray) {
  RTCRayHit traced = single(ray.ray);
  rtcIntersect1(scene, &traced);
  ray.ray.far = traced.ray.tfar;
  if (traced.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
  ray.hit.edges_cross = {traced.hit.Ng_x, traced.hit.Ng_y, traced.hit.Ng_z};
  ray.hit.u = traced.hit.u, ray.hit.v = traced.hit.v;
  ray.hit.triangle = traced.hit.primID, ray.hit.mesh = traced.hit.geomID;
  ray.hit.instance = traced.hit.instID[0];
}

void find_blocked(RTCScene scene, std::span<Ray> rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  for (std::size_t begin = 0; begin < rays.size(); begin += kPacket) {
    const std::span<Ray> part = rays.subspan(begin, std::min(kPacket, rays.size() - begin));
    const Mask mask(part.size());
    RTCRay16 packet{};
    for (std::size_t i = 0; i < part.size(); ++i) copy_to(packet, i, part[i]);
    rtcOccluded16(mask.valid, scene, &packet, &arguments);
    for (std::size_t i = 0; i < part.size(); ++i) part[i].far = packet.tfar[i];
  }
}

void find_hits_with(HitFilter filter, QueryContext& context, RTCScene scene, const Ray& ray) {
  rtcInitRayQueryContext(&context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  arguments.filter = filter;
  arguments.context = &context;
  RTCRayHit traced = single(ray);
  rtcIntersect1(scene, &traced, &arguments);
}

}  // namespace opaline

#else

namespace opaline {

static_assert(sizeof(TracedRay) == sizeof(RTCRayHit));
static_assert(offsetof(TracedRay, hit) == offsetof(RTCRayHit, hit) &&
              offsetof(Hit, u) == offsetof(RTCHit, u));
static_assert(offsetof(Hit, triangle) == offsetof(RTCHit, primID) &&
              offsetof(Hit, mesh) == offsetof(RTCHit, geomID));

namespace {

constexpr std::size_t kStream = 256;

RTCIntersectContext coherent_context() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

}  // namespace

void find_hits(RTCScene scene, std::span<TracedRay> rays) {
  RTCIntersectContext context = coherent_context();
  for (std::size_t begin = 0; begin < rays.size(); begin += kStream)
    rtcIntersect1M(scene, &context, reinterpret_cast<RTCRayHit*>(&rays[begin]),
                   unsigned(std::min(kStream, rays.size() - begin)), sizeof(RTCRayHit));
}

void find_hit(RTCScene scene, TracedRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, reinterpret_cast<RTCRayHit*>(&ray));
}

void find_blocked(RTCScene scene, std::span<Ray> rays) {
  RTCIntersectContext context = coherent_context();
  for (std::size_t begin = 0; begin < rays.size(); begin += kStream)
    rtcOccluded1M(scene, &context, reinterpret_cast<RTCRay*>(&rays[begin]),
                  unsigned(std::min(kStream, rays.size() - begin)), sizeof(RTCRay));
}

void find_hits_with(HitFilter filter, QueryContext& context, RTCScene scene, const Ray& ray) {
  rtcInitIntersectContext(&context);
  context.filter = filter;
  TracedRay traced{ray, {}};
  rtcIntersect1(scene, &context, reinterpret_cast<RTCRayHit*>(&traced));
}

}  // namespace opaline

#endif
