// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "lights/light.h"
#include "stages/stage_keys.h"

namespace opaline {
namespace {

struct Ball {
  Vec3d center;
  double radius;
};

/// Bounding sphere of all a body's meshes.
Ball ball_around(std::span<const MeshKeys> meshes, const BodyPlan& group) {
  Ball ball{};
  for (const std::uint32_t m : group.meshes) ball.center += meshes[m].center / double(group.meshes.size());
  for (const std::uint32_t m : group.meshes)
    ball.radius = std::max(ball.radius, length(meshes[m].center - ball.center) + meshes[m].radius);
  return ball;
}

/// True if the hull of two balls intersects a third: the ball interpolated at t is in the hull, and its gap
/// to the third is a convex function of t.
bool hull_meets(const Ball& a, const Ball& b, const Ball& third) {
  const auto gap = [&](double t) {
    return length(a.center + (b.center - a.center) * t - third.center) -
           (a.radius + (b.radius - a.radius) * t) - third.radius;
  };
  double low = 0, high = 1;
  for (int i = 0; i < 60 && std::min(gap(low), gap(high)) > 0; ++i) {
    const double p = low + (high - low) / 3, q = high - (high - low) / 3;
    (gap(p) > gap(q) ? low : high) = gap(p) > gap(q) ? p : q;
  }
  return std::min(gap(low), gap(high)) <= 0;
}

/// The ball swept infinitely along the direction.
bool sweep_meets(const Ball& ball, const Vec3d& direction, const Ball& other) {
  const Vec3d to = other.center - ball.center;
  const double along = std::max(0.0, dot(to, direction));
  return length(to - direction * along) <= ball.radius + other.radius;
}

}  // namespace

bool may_shadow(std::span<const MeshKeys> meshes, std::uint32_t mesh, const BodyPlan& group,
                const Light& light, double unit) {
  if (std::ranges::find(group.meshes, mesh) != group.meshes.end()) return true;
  Ball target = ball_around(meshes, group);
  // Includes the lift to the smooth surface (to at most 1.09 radii, for a tessellated sphere), the ray offset,
  // and the search for the surface beside a sample.
  target.radius = 1.1 * target.radius + 3 * group.spacing / unit;
  const Ball blocker{meshes[mesh].center, meshes[mesh].radius};
  const LightExtent source = extent(light);
  if (source.center) return hull_meets(target, {*source.center, source.radius}, blocker);
  return !source.towards || sweep_meets(target, *source.towards, blocker);
}

}  // namespace opaline
