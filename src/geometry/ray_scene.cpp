// SPDX-License-Identifier: GPL-3.0-or-later
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <ctime>
#include <string>

#include "opaline/core/error.h"
#include "opaline/core/parallel.h"
#include "opaline/geometry/world.h"

namespace opaline {

struct RayScene::Handles {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::atomic<std::ptrdiff_t> bytes{0};
  std::atomic<std::uint64_t> rays{0}, nanoseconds{0};

  ~Handles() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

constexpr std::size_t kBatch = 256;

bool count_memory(void* counter, ssize_t bytes, bool) {
  *static_cast<std::atomic<std::ptrdiff_t>*>(counter) += bytes;
  return true;
}

void check(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw run_failed({}, "out of memory while building the ray structure");
  require(error == RTC_ERROR_NONE, "Embree reports an error");
}

void attach_mesh(RTCDevice device, RTCScene scene, const Mesh& mesh, unsigned id) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.positions.size()));
  auto* indices = static_cast<std::array<std::uint32_t, 3>*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              sizeof(std::array<std::uint32_t, 3>), mesh.triangles.size()));
  check(device);
  std::ranges::transform(mesh.positions, vertices, [](const Vec3d& p) { return Vec3f(p); });
  std::ranges::copy(mesh.triangles, indices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

RTCRay to_embree(const Ray& ray) {
  RTCRay r{};
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.tnear = ray.near;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.tfar = ray.far;
  r.mask = ~0u;
  return r;
}

std::uint64_t thread_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::uint64_t(now.tv_sec) * 1000000000u + std::uint64_t(now.tv_nsec);
}

// Adds the rays and CPU time of a scope to the counters.
class CountRays {
 public:
  CountRays(std::atomic<std::uint64_t>& rays, std::atomic<std::uint64_t>& nanoseconds, std::size_t n)
      : nanoseconds_(nanoseconds), start_(thread_nanoseconds()) {
    rays.fetch_add(n, std::memory_order_relaxed);
  }
  ~CountRays() { nanoseconds_.fetch_add(thread_nanoseconds() - start_, std::memory_order_relaxed); }
  CountRays(const CountRays&) = delete;
  CountRays& operator=(const CountRays&) = delete;

 private:
  std::atomic<std::uint64_t>& nanoseconds_;
  std::uint64_t start_;
};

RTCIntersectContext coherent_context() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

}  // namespace

RayScene::RayScene(const World& world) : handles_(std::make_unique<Handles>()) {
  handles_->device = rtcNewDevice(nullptr);
  require(handles_->device != nullptr, "Embree has no device");
  rtcSetDeviceMemoryMonitorFunction(handles_->device, count_memory, &handles_->bytes);
  handles_->scene = rtcNewScene(handles_->device);
  rtcSetSceneFlags(handles_->scene, RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < world.meshes.size(); ++i)
    attach_mesh(handles_->device, handles_->scene, world.meshes[i], unsigned(i));
  rtcCommitScene(handles_->scene);
  check(handles_->device);
  for (const Mesh& mesh : world.meshes) {
    const Bounds box = bounds(mesh);
    offsets_.push_back(float(length(box.high - box.low) * 0x1p-18));
    largest_offset_ = std::max(largest_offset_, offsets_.back());
  }
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;

std::size_t RayScene::bytes() const { return std::size_t(handles_->bytes.load()); }

RayScene::Statistics RayScene::statistics() const {
  return {handles_->rays, 1e-9 * double(handles_->nanoseconds)};
}

void RayScene::intersect(std::span<const Ray> rays, std::span<Hit> hits) const {
  const FlushDenormals mode;
  RTCIntersectContext context = coherent_context();
  std::array<RTCRayHit, kBatch> batch;
  for (std::size_t begin = 0; begin < rays.size(); begin += kBatch) {
    const std::size_t n = std::min(kBatch, rays.size() - begin);
    for (std::size_t i = 0; i < n; ++i) {
      batch[i].ray = to_embree(rays[begin + i]);
      batch[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
      batch[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    {
      const CountRays count(handles_->rays, handles_->nanoseconds, n);
      rtcIntersect1M(handles_->scene, &context, batch.data(), unsigned(n), sizeof(RTCRayHit));
    }
    for (std::size_t i = 0; i < n; ++i) {
      const RTCHit& hit = batch[i].hit;
      hits[begin + i] = {hit.geomID, hit.primID, batch[i].ray.tfar, hit.u, hit.v};
    }
  }
}

void RayScene::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
  const FlushDenormals mode;
  RTCIntersectContext context = coherent_context();
  std::array<RTCRay, kBatch> batch;
  for (std::size_t begin = 0; begin < rays.size(); begin += kBatch) {
    const std::size_t n = std::min(kBatch, rays.size() - begin);
    for (std::size_t i = 0; i < n; ++i) batch[i] = to_embree(rays[begin + i]);
    {
      const CountRays count(handles_->rays, handles_->nanoseconds, n);
      rtcOccluded1M(handles_->scene, &context, batch.data(), unsigned(n), sizeof(RTCRay));
    }
    for (std::size_t i = 0; i < n; ++i) blocked[begin + i] = batch[i].tfar < 0 ? 1 : 0;
  }
}

}  // namespace opaline
