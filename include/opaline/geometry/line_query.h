// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that a line crosses.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "opaline/geometry/ray_scene.h"

namespace opaline {

/// Crossings of lines with some meshes of a RayScene, which must outlive it.
class LineQuery {
 public:
  LineQuery(const RayScene& rays, std::span<const std::uint32_t> meshes);
  ~LineQuery();
  LineQuery(LineQuery&&) noexcept;
  LineQuery& operator=(LineQuery&&) = delete;

  /// Replaces `crossings` by every triangle that the ray meets between near and far, whichever side it shows,
  /// each once, in no particular but a fixed order.
  void find(const Ray& ray, std::vector<Hit>& crossings) const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace opaline
