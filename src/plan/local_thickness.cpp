// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/local_thickness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/surface_point.h"
#include "opaline/vec3.h"
#include "sampling/draft_samples.h"

namespace opaline {
namespace {

constexpr std::size_t kPlaces = 400;
constexpr double kOpposite = -.3;  // largest cosine between the normals of opposite places
// Largest distance of the opposite place from the axis along the normal: in spacings, or in depths.
constexpr double kSpacings = 1.2, kDepths = .5;

struct Place {
  Vec3d position, normal;  // world units
};

}  // namespace

std::vector<double> local_thicknesses(const World& world, std::span<const std::uint32_t> meshes) {
  const SurfaceSamples drafts = draft_samples(world, meshes, kPlaces);
  const double spacing = drafts.samples.empty() ? 0 : std::sqrt(drafts.area / double(drafts.samples.size()));
  std::vector<Place> places;
  for (const SurfaceSample& sample : drafts.samples) {
    const SurfacePoint point = surface_point(world.meshes[sample.mesh], sample.triangle, sample.u, sample.v);
    places.push_back({Vec3d(point.position), Vec3d(point.geometric)});
  }
  std::vector<double> thicknesses;
  for (const Place& place : places) {
    double least = std::numeric_limits<double>::infinity();
    for (const Place& other : places) {
      if (!(dot(place.normal, other.normal) < kOpposite)) continue;
      const Vec3d apart = other.position - place.position;
      const double depth = -dot(apart, place.normal);
      if (!(depth > 0 && depth < least && dot(apart, other.normal) > 0)) continue;
      const double from_axis = std::max(kSpacings * spacing, kDepths * depth);
      if (dot(apart, apart) - depth * depth < from_axis * from_axis) least = depth;
    }
    thicknesses.push_back(least * world.unit);
  }
  return thicknesses;
}

}  // namespace opaline
