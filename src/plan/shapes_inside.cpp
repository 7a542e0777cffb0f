// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/shapes_inside.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "geometry/follow_ray.h"
#include "scene/names.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

constexpr std::size_t kTested = 64;                         // vertices of a shape
constexpr std::size_t kMostPairs = 1'000'000;               // bodies times shapes
const Vec3d kDirection = normalized(Vec3d{.31, .87, .39});  // along no axis

bool is_of(const BodyPlan& body, std::size_t mesh) {
  return std::ranges::find(body.meshes, mesh) != body.meshes.end();
}

/// True if a ray from the point leaves the body once more often than it enters.
bool is_inside(const RayScene& rays, const BodyPlan& body, const Vec3d& point) {
  int crossed = 0;
  follow_ray(rays, point, kDirection, std::numeric_limits<double>::infinity(), [&](const TracedRay& traced) {
    if (is_of(body, traced.hit.mesh)) crossed += leaves(traced.hit, kDirection) ? 1 : -1;
    return true;
  });
  return crossed > 0;
}

/// True if the vertices of the shape inside the body span a considerable part of it.
bool reaches_inside(const World& world, const RayScene& rays, const BodyPlan& body, std::size_t other) {
  Bounds box = bounds(world, body.meshes);
  const Vec3d margin = (box.high - box.low) * 1e-5;  // surfaces that touch
  box.low += margin;
  box.high = box.high - margin;
  if (!meet(box, bounds(world.meshes[other]))) return false;
  std::vector<Vec3d> candidates;
  for (const Vec3d& p : world.meshes[other].positions)
    if (min_component(p - box.low) > 0 && min_component(box.high - p) > 0) candidates.push_back(p);
  const std::size_t step = std::max(candidates.size() / kTested, std::size_t{1});
  constexpr double kConsiderable = .2;  // fraction of the diagonal, more than the stem of an apple
  Bounds inside;
  for (std::size_t i = 0; i < candidates.size(); i += step)
    if (is_inside(rays, body, candidates[i])) widen(inside.low, inside.high, candidates[i]);
  return inside.low.x <= inside.high.x &&
         length(inside.high - inside.low) > kConsiderable * length(box.high - box.low);
}

}  // namespace

std::vector<std::string> warnings_of_shapes_inside(const Scene& scene, const World& world,
                                                   const RayScene& rays, const Plan& plan) {
  std::vector<std::string> warnings;
  if (plan.groups.size() * world.meshes.size() > kMostPairs) return warnings;
  for (const BodyPlan& body : plan.groups) {
    if (!method_of(body.method).has_model() || !(body.thickness > 0)) continue;
    for (std::size_t other = 0; other < world.meshes.size(); ++other)
      if (!is_of(body, other) && reaches_inside(world, rays, body, other))
        warnings.push_back(fmt::format(
            "{}: the shape '{}' lies inside, but the method {} ignores it there; --method volume does not",
            body.name, scene.shapes[other].name, name_of(body.method)));
  }
  return warnings;
}

}  // namespace opaline
