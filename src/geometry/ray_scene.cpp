// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/ray_scene.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <ctime>

#include "core/parallel.h"
#include "geometry/embree_handles.h"
#include "geometry/oriented_point.h"
#include "geometry/ray_offset.h"
#include "opaline/error.h"

namespace opaline {

namespace {

std::uint64_t thread_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::uint64_t(now.tv_sec) * 1000000000u + std::uint64_t(now.tv_nsec);
}

template <class Trace>
void count(RayCounter& counter, std::size_t rays, const Trace& trace) {
  constexpr std::uint64_t kTimedEvery = 8;
  counter.rays.fetch_add(rays, std::memory_order_relaxed);
  if (counter.batches.fetch_add(1, std::memory_order_relaxed) % kTimedEvery != 0) return trace();
  const std::uint64_t start = thread_nanoseconds();
  trace();
  counter.timed_nanoseconds.fetch_add(thread_nanoseconds() - start, std::memory_order_relaxed);
  counter.timed_rays.fetch_add(rays, std::memory_order_relaxed);
}

}  // namespace

namespace {

constexpr std::size_t kBatch = 256;
constexpr float kFlat = 1 - 1e-6f;  // cosine of vertex normals equal to the triangle's but for rounding

RTCBuildQuality quality_of(RayBuild build) {
  return build == RayBuild::quick ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

}  // namespace

// Embree reports some failures of memory or threads as unknown, because its allocators and system calls throw
// different exceptions.
void check_device(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY || error == RTC_ERROR_UNKNOWN)
    throw run_failed({}, "out of memory while building the ray structure");
  if (error == RTC_ERROR_UNSUPPORTED_CPU) throw run_failed({}, "Embree does not support this processor");
  require(error == RTC_ERROR_NONE, "Embree reports an error");
}

RayScene::RayScene(const World& world, RayBuild build, std::span<const MeshMotion> motions)
    : handles_(std::make_unique<Handles>()) {
  handles_->device = rtcNewDevice(nullptr);
  if (handles_->device == nullptr) check_device(nullptr);
  require(handles_->device != nullptr, "Embree has no device");
  handles_->scene = rtcNewScene(handles_->device);
  rtcSetSceneFlags(handles_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(handles_->scene, quality_of(build));
  for (std::size_t i = 0; i < world.meshes.size(); ++i)
    attach(world, i, build, motions.empty() ? MeshMotion{} : motions[i]);
  rtcCommitScene(handles_->scene);
  handles_->check();
}

// Leaks a device that failed to start all threads: Embree ends the process on releasing it.
void RayScene::Handles::check() {
  try {
    check_device(device);
  } catch (const Error&) {
    scene = nullptr, device = nullptr;
    throw;
  }
}

void RayScene::attach(const World& world, std::size_t index, RayBuild build, const MeshMotion& motion) {
  const Mesh& mesh = world.meshes[index];
  RTCGeometry geometry = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(geometry, quality_of(build));
  std::vector<Vertex> vertices(mesh.positions.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    vertices[i] = {Vec3f(mesh.positions[i]), mesh.normals.empty() ? Vec3f{} : mesh.normals[i]};
  std::vector<std::vector<Vertex>> moved(motion.size());
  const unsigned steps = std::max(1u, unsigned(motion.size()));
  rtcSetGeometryTimeStepCount(geometry, steps);
  for (unsigned i = 0; i < steps; ++i) {
    if (i != steps / 2)
      for (const Vec3f& p : motion[i]) moved[i].push_back({p, {}});
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, i, RTC_FORMAT_FLOAT3,
                               i == steps / 2 ? vertices.data() : moved[i].data(), 0, sizeof(Vertex),
                               vertices.size());
  }
  auto* indices = static_cast<std::array<std::uint32_t, 3>*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              sizeof(std::array<std::uint32_t, 3>), mesh.triangles.size()));
  handles_->check();
  std::ranges::copy(mesh.triangles, indices);
  std::unique_ptr<Cutout> cutout;
  if (!world.opacities.empty() && world.opacities[index]) {
    cutout = std::make_unique<Cutout>(Cutout{*world.opacities[index], mesh.uvs});
    rtcSetGeometryUserData(geometry, cutout.get());
    rtcSetGeometryIntersectFilterFunction(geometry, pass_holes);
    rtcSetGeometryOccludedFilterFunction(geometry, pass_holes);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(handles_->scene, geometry, unsigned(meshes_.size()));
  rtcReleaseGeometry(geometry);
  const Bounds box = bounds(mesh);
  const float offset = float(length(box.high - box.low) * double(kRayOffsetOfSize));
  meshes_.push_back(
      {std::move(vertices), std::move(moved), std::move(cutout), indices, mesh.normals.empty(), offset});
  largest_offset_ = std::max(largest_offset_, offset);
}

void RayScene::set_motion(const World& world, std::span<const MeshMotion> motions) {
  moving_ = nullptr;
  if (!motions.empty()) moving_ = std::make_unique<RayScene>(world, RayBuild::careful, motions);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;

RayScene::Statistics RayScene::statistics() const {
  Statistics all{handles_->intersected.rays + handles_->occluded.rays,
                 handles_->intersected.seconds() + handles_->occluded.seconds()};
  if (moving_ == nullptr) return all;
  const Statistics moving = moving_->statistics();
  all.rays += moving.rays;
  all.seconds += moving.seconds;
  return all;
}

// Counted by batches; reads the clock for every eighth.
void RayScene::intersect(std::span<TracedRay> rays) const {
  const FlushDenormals mode;
  for (std::size_t begin = 0; begin < rays.size(); begin += kBatch) {
    const std::span<TracedRay> batch = rays.subspan(begin, std::min(kBatch, rays.size() - begin));
    count(handles_->intersected, batch.size(), [&] { find_hits(handles_->scene, batch); });
  }
}

void RayScene::intersect_one(TracedRay& ray) const {
  find_hit(handles_->scene, ray);
}

void RayScene::occluded(std::span<Ray> rays) const {
  const FlushDenormals mode;
  for (std::size_t begin = 0; begin < rays.size(); begin += kBatch) {
    const std::span<Ray> batch = rays.subspan(begin, std::min(kBatch, rays.size() - begin));
    count(handles_->occluded, batch.size(), [&] { find_blocked(handles_->scene, batch); });
  }
}

SurfacePoint RayScene::surface_point(std::uint32_t mesh, std::uint32_t triangle, float u, float v) const {
  const MeshView& view = meshes_[mesh];
  const auto& corner = view.triangles[triangle];
  const Vertex &a = view.vertices[corner[0]], &b = view.vertices[corner[1]], &c = view.vertices[corner[2]];
  const Vec3f ab = b.position - a.position, ac = c.position - a.position;
  const Vec3f normal = a.normal * (1 - u - v) + b.normal * u + c.normal * v;
  SurfacePoint point = oriented_point(a.position + ab * u + ac * v, ab, ac, view.faceted ? nullptr : &normal);
  point.offset = offset(mesh, point.position);
  point.mesh = mesh, point.triangle = triangle;
  point.u = u, point.v = v;
  return point;
}

float RayScene::tilt(const SurfacePoint& point) const {
  if (point.mesh == SurfacePoint::kNoMesh || meshes_[point.mesh].faceted) return -1;
  const MeshView& view = meshes_[point.mesh];
  float cosine = 1;
  for (const std::uint32_t corner : view.triangles[point.triangle])
    cosine = std::min(cosine, std::abs(dot(view.vertices[corner].normal, point.geometric)));
  return cosine > kFlat ? -1 : std::sqrt(1 - cosine * cosine);
}

Vec3f RayScene::lift(const SurfacePoint& point) const {
  const MeshView& view = meshes_[point.mesh];
  const auto& corners = view.triangles[point.triangle];
  const std::array<float, 3> weights{1 - point.u - point.v, point.u, point.v};
  Vec3f position, normal;
  for (std::size_t k = 0; k < 3; ++k) {
    position += view.vertices[corners[k]].position * weights[k];
    normal += view.vertices[corners[k]].normal * weights[k];
  }
  const float side = dot(normal, point.geometric) < 0 ? -1.0f : 1.0f;  // -1: the back of a sheet
  Vec3f lift;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vertex& vertex = view.vertices[corners[k]];
    const Vec3f outward = vertex.normal * side;
    lift += outward * (weights[k] * std::max(0.0f, dot(vertex.position - position, outward)));
  }
  return lift;
}

float RayScene::offset(std::uint32_t mesh, const Vec3f& p) const {
  return meshes_[mesh].offset + kRayOffsetOfPosition * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z));
}

}  // namespace opaline
