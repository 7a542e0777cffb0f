// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/render/across_air.h"

#include <algorithm>
#include <vector>

#include "opaline/core/random.h"
#include "opaline/core/vec3.h"
#include "opaline/diffusion/diffuse_profile.h"

namespace opaline {
namespace {

constexpr std::size_t kPlaces = 500, kMostTriangles = 20'000;
constexpr std::uint64_t kSeed = 5100;
// Cosine of a chord and the normal above which it starts outside: beside it surfaces that are merely concave go around.
constexpr double kOutward = .5;

struct Place {
  Vec3d position, normal;  // mm
};

/// Spread over the area; where triangles are many, over some of them.
std::vector<Place> places_on(const World& world, const std::vector<std::uint32_t>& meshes) {
  std::size_t triangles = 0;
  for (const std::uint32_t m : meshes) triangles += world.meshes[m].triangles.size();
  const std::size_t step = triangles / kMostTriangles + 1;
  struct Face {
    Vec3d a, ab, ac;
    double area_before;
  };
  std::vector<Face> faces;
  double area = 0;
  for (const std::uint32_t m : meshes) {
    const Mesh& mesh = world.meshes[m];
    for (std::size_t t = 0; t < mesh.triangles.size(); t += step) {
      const auto& [i, j, k] = mesh.triangles[t];
      const Vec3d a = mesh.positions[i] * world.unit;
      faces.push_back({a, mesh.positions[j] * world.unit - a, mesh.positions[k] * world.unit - a, area});
      area += .5 * length(cross(faces.back().ab, faces.back().ac));
    }
  }
  std::vector<Place> places;
  std::size_t next = 0;
  for (std::size_t p = 0; p < kPlaces && area > 0; ++p) {
    const double wanted = area * (double(p) + unit_double(hash_bits(kSeed, p))) / double(kPlaces);
    while (next + 1 < faces.size() && faces[next + 1].area_before <= wanted) ++next;
    const Face& face = faces[next];
    auto [u, v] = r2_point(p, {.5, .5});
    if (u + v > 1) u = 1 - u, v = 1 - v;
    places.push_back({face.a + face.ab * u + face.ac * v, normalized(cross(face.ab, face.ac))});
  }
  return places;
}

}  // namespace

double share_across_air(const Scene& scene, const World& world, const GroupPlan& group) {
  if (group.method != Method::hierarchical && group.method != Method::direct) return 0;
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
