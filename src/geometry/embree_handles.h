// SPDX-License-Identifier: GPL-3.0-or-later
// What ray and line queries share of Embree.
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "opaline/geometry/ray_scene.h"

namespace opaline {

static_assert(sizeof(Ray) == sizeof(RTCRay) && sizeof(TracedRay) == sizeof(RTCRayHit));
static_assert(offsetof(Ray, near) == offsetof(RTCRay, tnear) &&
              offsetof(Ray, direction) == offsetof(RTCRay, dir_x));
static_assert(offsetof(Ray, far) == offsetof(RTCRay, tfar) && offsetof(Ray, mask) == offsetof(RTCRay, mask));
static_assert(offsetof(TracedRay, hit) == offsetof(RTCRayHit, hit) &&
              offsetof(Hit, u) == offsetof(RTCHit, u));
static_assert(offsetof(Hit, triangle) == offsetof(RTCHit, primID) &&
              offsetof(Hit, mesh) == offsetof(RTCHit, geomID));

// Rays of one kind and the time of those batches that were timed.
struct RayCounter {
  std::atomic<std::uint64_t> rays{0}, batches{0}, timed_rays{0}, timed_nanoseconds{0};

  double seconds() const {
    return timed_rays > 0 ? 1e-9 * double(timed_nanoseconds) * double(rays) / double(timed_rays) : 0;
  }
};

struct RayScene::Handles {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  RayCounter intersected, occluded;

  /// Throws as check_device.
  void check();
  ~Handles() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

// One cache line holds two of them: a hit's interpolation reads three.
struct alignas(32) RayScene::Vertex {
  Vec3f position, normal;
};

struct RayScene::MeshView {
  std::vector<Vertex> vertices;  // shared with Embree, whose own buffers begin at any 16 bytes
  const std::array<std::uint32_t, 3>* triangles;  // Embree's buffer
  bool faceted;
  float offset;
};

/// Throws Error{run_failed} where the device ran out of memory.
void check_device(RTCDevice device);

}  // namespace opaline
