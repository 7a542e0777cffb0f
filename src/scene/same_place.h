// SPDX-License-Identifier: GPL-3.0-or-later
// Motion of a shape.
#pragma once

#include "opaline/scene.h"

namespace opaline {

/// True if both shapes have the same vertices and holes.
inline bool in_same_place(const Shape& a, const Shape& b) {
  return a.source == b.source && a.to_world == b.to_world && a.displacement == b.displacement &&
         a.opacity == b.opacity;
}

/// True if a point moves on an almost straight way: on an arc of at most 11 degrees.
inline bool is_between(const Vec3d& middle, const Vec3d& first, const Vec3d& last) {
  constexpr double kMostBent = .025;  // sagitta over chord
  return length(middle - (first + last) * .5) <= kMostBent * length(last - first) + 1e-9 * length(middle);
}

/// The same for the axes of a shape's space.
inline bool is_between(const Transform& middle, const Transform& first, const Transform& last) {
  return is_between(middle.x, first.x, last.x) && is_between(middle.y, first.y, last.y) &&
         is_between(middle.z, first.z, last.z) &&
         is_between(middle.translation, first.translation, last.translation);
}

/// The same for the camera and all shapes.
inline bool is_between(const ShutterPose& middle, const ShutterPose& first, const ShutterPose& last) {
  const auto forward = [](const Camera& camera) { return normalized(camera.look_at - camera.position); };
  bool all = is_between(middle.camera.position, first.camera.position, last.camera.position) &&
             is_between(forward(middle.camera), forward(first.camera), forward(last.camera)) &&
             is_between(middle.camera.up, first.camera.up, last.camera.up);
  for (std::size_t i = 0; i < middle.shapes.size(); ++i)
    all = all && is_between(middle.shapes[i].to_world, first.shapes[i].to_world, last.shapes[i].to_world);
  return all;
}

}  // namespace opaline
