// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "opaline/cache/stage_keys.h"

namespace opaline {
namespace {

struct Ball {
  Vec3d center;
  double radius;
};

/// Around the balls of all a group's meshes.
Ball ball_around(std::span<const MeshKeys> meshes, const GroupPlan& group) {
  Ball ball{};
  for (const std::uint32_t m : group.meshes) ball.center += meshes[m].center / double(group.meshes.size());
  for (const std::uint32_t m : group.meshes)
    ball.radius = std::max(ball.radius, length(meshes[m].center - ball.center) + meshes[m].radius);
  return ball;
}

/// Where the light comes from: a ball, or a direction towards it; neither for light from everywhere.
struct Source {
  std::optional<Ball> ball;
  std::optional<Vec3d> direction;
};

struct SourceOf {
  Source operator()(const PointLight& light) const { return {Ball{light.position, 0}, {}}; }
  Source operator()(const DirectionalLight& light) const { return {{}, -light.direction}; }
  Source operator()(const SphereLight& light) const { return {Ball{light.center, light.radius}, {}}; }
  Source operator()(const QuadLight& light) const {
    const double radius = 0.5 * std::max(length(light.u + light.v), length(light.u - light.v));
    return {Ball{light.corner + 0.5 * (light.u + light.v), radius}, {}};
  }
  Source operator()(const Surroundings&) const { return {}; }
};

/// Whether the hull of both balls meets the third: their mix at t is a ball of the hull, and its gap to the
/// third is a convex function of t.
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

/// The ball swept along the direction for ever.
bool sweep_meets(const Ball& ball, const Vec3d& direction, const Ball& other) {
  const Vec3d to = other.center - ball.center;
  const double along = std::max(0.0, dot(to, direction));
  return length(to - direction * along) <= ball.radius + other.radius;
}

}  // namespace

bool may_shadow(std::span<const MeshKeys> meshes, std::uint32_t mesh, const GroupPlan& group,
                const Light& light, double unit) {
  if (std::ranges::find(group.meshes, mesh) != group.meshes.end()) return true;
  Ball target = ball_around(meshes, group);
  // Rays look for the surface beside a sample, too, and leave it at a small distance.
  target.radius = 1.01 * target.radius + 3 * group.spacing / unit;
  const Ball blocker{meshes[mesh].center, meshes[mesh].radius};
  const Source source = std::visit(SourceOf{}, light.source);
  if (source.ball) return hull_meets(target, *source.ball, blocker);
  return !source.direction || sweep_meets(target, *source.direction, blocker);
}

}  // namespace opaline
