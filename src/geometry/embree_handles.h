// SPDX-License-Identifier: GPL-3.0-or-later
// Embree records shared by ray, line and nearest-point queries.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "geometry/embree.h"
#include "geometry/ray_scene.h"

namespace opaline {

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
