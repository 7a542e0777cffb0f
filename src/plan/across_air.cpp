// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/across_air.h"

#include <algorithm>
#include <vector>

#include "diffusion/diffuse_profile.h"
#include "geometry/surface_point.h"
#include "opaline/vec3.h"
#include "sampling/draft_samples.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

constexpr std::size_t kPlaces = 500;
// Least cosine between a chord and the normal for the chord to start outside. Slightly concave surfaces stay
// below it.
constexpr double kOutward = .5;

struct Place {
  Vec3d position, normal;  // mm
};

std::vector<Place> places_on(const World& world, const std::vector<std::uint32_t>& meshes) {
  std::vector<Place> places;
  for (const SurfaceSample& sample : draft_samples(world, meshes, kPlaces).samples) {
    const Mesh& mesh = world.meshes[sample.mesh];
    const SurfacePoint point = surface_point(mesh, sample.triangle, sample.u, sample.v);
    places.push_back({Vec3d(point.position) * world.unit, Vec3d(point.geometric)});
  }
  return places;
}

}  // namespace

double share_across_air(const Scene& scene, const World& world, const BodyPlan& group) {
  const SubsurfaceMethod& method = method_of(group.method);
  if (!method.uses_radial_profile() || !method.spreads_light()) return 0;
  const DiffuseProfile profile = make_diffuse_profile(scene.media[group.medium]);
  const std::vector<Place> places = places_on(world, group.meshes);
  const double area = group.area / double(kPlaces);
  Rgb carried{};
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3d apart = places[j].position - places[i].position;
      const double out = dot(apart, places[i].normal), into = -dot(apart, places[j].normal);
      if (!(out > 0 && into > 0)) continue;
      const double distance = length(apart);
      if (!(std::min(out, into) > kOutward * distance)) continue;
      for (std::size_t c = 0; c < 3; ++c)
        if (profile.total[c] > 0)
          carried[c] += 2 * std::min(1., area / profile.total[c] *
                                             diffuse_reflectance_profile(profile.channels[c], distance));
    }
  return std::min(1., max_component(carried) / double(kPlaces));
}

}  // namespace opaline
