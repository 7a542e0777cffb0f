// SPDX-License-Identifier: GPL-3.0-or-later
#include "subsurface/light_distance.h"

#include <fmt/format.h>

#include <array>

#include "lights/light.h"

namespace opaline {
namespace {

struct Segment {
  Vec3d start, along;
};

using Corners = std::array<Vec3d, 3>;

std::optional<Segment> middle_of(const Light& light, double limit) {
  const LightExtent place = extent(light);
  if (!place.center || place.width / 2 >= limit) return {};
  return Segment{*place.center - place.along * .5, place.along};
}

double squared_distance(const Vec3d& p, const Segment& segment) {
  const double length2 = dot(segment.along, segment.along);
  const double t = length2 > 0 ? std::clamp(dot(p - segment.start, segment.along) / length2, 0., 1.) : 0;
  const Vec3d apart = p - (segment.start + segment.along * t);
  return dot(apart, apart);
}

double squared_distance(const Vec3d& p, const Corners& corners) {
  const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double normal2 = dot(normal, normal);
  bool above = normal2 > 0;
  double to_border = INFINITY;
  for (std::size_t i = 0; i < 3; ++i) {
    const Segment edge{corners[i], corners[(i + 1) % 3] - corners[i]};
    above = above && dot(cross(edge.along, p - edge.start), normal) >= 0;
    to_border = std::min(to_border, squared_distance(p, edge));
  }
  const double height = dot(p - corners[0], normal);
  return above ? height * height / normal2 : to_border;
}

/// Ternary search: the distance from a triangle is convex along a line.
double squared_distance(const Segment& segment, const Corners& corners) {
  const auto at = [&](double t) { return squared_distance(segment.start + segment.along * t, corners); };
  double low = 0, high = 1;
  if (dot(segment.along, segment.along) > 0)
    for (int i = 0; i < 60; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      const bool rises = at(a) < at(b);
      (rises ? high : low) = rises ? b : a;
    }
  return at(low);
}

/// True if all points of the ball are at least `distance` from the segment.
bool is_beyond(const Segment& segment, const Vec3d& center, double radius, double distance) {
  return squared_distance(center, segment) >= (distance + radius) * (distance + radius);
}

/// The least of `nearest` and the segment's distance from the mesh.
double nearest_of_mesh(const Segment& segment, const Mesh& mesh, double nearest) {
  const Bounds box = bounds(mesh);
  if (is_beyond(segment, .5 * (box.low + box.high), length(box.high - box.low) / 2, nearest)) return nearest;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Corners corners{mesh.positions[a], mesh.positions[b], mesh.positions[c]};
    // The ball around the first corner is the cheapest bound of the triangle.
    const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    if (is_beyond(segment, corners[0], std::sqrt(std::max(dot(ab, ab), dot(ac, ac))), nearest)) continue;
    nearest = std::min(nearest, std::sqrt(squared_distance(segment, corners)));
  }
  return nearest;
}

}  // namespace

std::optional<double> near_light_distance(const Light& light, const World& world,
                                          std::span<const std::uint32_t> meshes, double limit) {
  const double widest = limit / world.unit;
  const std::optional<Segment> middle = middle_of(recentred(light, world.origin, world.unit), widest);
  if (!middle) return {};
  double nearest = widest;
  for (const std::uint32_t mesh : meshes) nearest = nearest_of_mesh(*middle, world.meshes[mesh], nearest);
  return nearest < widest ? std::optional(nearest * world.unit) : std::nullopt;
}

void warn_of_near_lights(const Scene& scene, const World& world, const BodyPlan& body,
                         std::vector<std::string>& warnings) {
  for (const Light& light : scene.lights) {
    if (emission(light) == Rgb{} || is_of_shape(light)) continue;
    const std::optional<double> distance = near_light_distance(light, world, body.meshes, body.spacing);
    if (!distance) continue;
    warnings.push_back(fmt::format(
        "{}: the light {} is {:.3g} mm from the surface, closer than the sample spacing of {:.3g} mm, so the "
        "samples miss part of its light; move the light away or reduce settings.sample_spacing",
        body.name, light.name, *distance < 1e-3 * body.spacing ? 0 : *distance, body.spacing));
  }
}

}  // namespace opaline
