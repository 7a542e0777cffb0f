// SPDX-License-Identifier: GPL-3.0-or-later
// Embree records shared by ray, line and nearest-point queries.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/cutout.h"
#include "geometry/embree.h"
#include "geometry/ray_scene.h"

namespace opaline {

// Number of rays of one kind, and time of the timed batches.
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

// A cache line contains two of them: a hit's interpolation reads three.
struct alignas(32) RayScene::Vertex {
  Vec3f position, normal;
};

struct RayScene::MeshView {
  std::vector<Vertex> vertices;            // shared with Embree; its own buffers are aligned to 16 bytes only
  std::vector<std::vector<Vertex>> moved;  // likewise: at equal steps of time; empty: still
  std::unique_ptr<Cutout> cutout;          // referred to by Embree; null: no holes
  const std::array<std::uint32_t, 3>* triangles;  // Embree's buffer
  bool faceted;
  float offset;
};

/// Throws Error{run_failed} where the device ran out of memory.
void check_device(RTCDevice device);

}  // namespace opaline
