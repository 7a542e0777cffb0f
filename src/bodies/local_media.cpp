// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies/local_media.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/random.h"
#include "diffusion/diffuse_profile.h"
#include "geometry/nearest_surface.h"
#include "scene/scene_properties.h"
#include "volume/volume_diffusion.h"

namespace opaline {

LocalMedia::LocalMedia(const Scene& scene, const World& world, const Medium& medium)
    : world_(world),
      textures_(scene, world),
      mean_(std::get<ArtistMedium>(medium.coefficients)),
      eta_(medium.eta) {
  constexpr std::size_t kTotals = 257;
  for (std::size_t i = 0; i < kTotals; ++i) {
    const double root = double(i) / double(kTotals - 1);
    totals_.push_back(
        total_diffuse_reflectance(make_channel_profile(profile_kind(medium), {1, root * root, eta_})));
  }
}

// Interpolates between media of the table: the total is nearly linear in the root of the absorbed fraction.
double LocalMedia::absorbed(double color) const {
  const auto below = std::ranges::lower_bound(totals_, color, std::greater());
  if (below == totals_.begin()) return 0;
  if (below == totals_.end()) return 1;
  const double above = *(below - 1);
  const double place = double(below - totals_.begin()) - (color - *below) / (above - *below);
  const double root = place / double(totals_.size() - 1);
  return root * root;
}

std::array<ReducedMedium, 3> LocalMedia::at(std::uint32_t mesh, std::uint32_t triangle, float u, float v,
                                            float width) const {
  const Vec3f normal = surface_point(world_.meshes[mesh], triangle, u, v).geometric;
  Footprint footprint;
  tangent_frame(normal, footprint.x, footprint.y);
  footprint.x *= width;
  footprint.y *= width;
  const MediumFactors factors = textures_.medium(textures_.place(mesh, triangle, u, v, footprint));
  std::array<ReducedMedium, 3> media;
  for (std::size_t c = 0; c < 3; ++c) {
    const double color = std::min(1., mean_.subsurface_color[c] * double(factors.color[c]));
    const double radius = mean_.subsurface_radius[c] * double(std::max(factors.radius[c], kLeastRadius));
    const double not_scattered = absorbed(color);
    media[c] = {reduced_mean_free_path(radius, not_scattered, mean_.anisotropy) / world_.unit, not_scattered,
                eta_};
  }
  return media;
}

namespace {

/// Calls visit(mesh, triangle, u, v) at points spread over the area of a body, in order of its triangles.
template <class Visit>
void for_places(const World& world, const BodyPlan& group, std::size_t places, const Visit& visit) {
  const double area = area_of(world, group.meshes);
  double before = 0;
  std::size_t next = 0;
  for (const std::uint32_t m : group.meshes) {
    const Mesh& mesh = world.meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [i, j, k] = mesh.triangles[t];
      const Vec3d& a = mesh.positions[i];
      before += .5 * length(cross(mesh.positions[j] - a, mesh.positions[k] - a));
      for (; next < places && (double(next) + .5) * area < before * double(places); ++next) {
        const auto [u, v] = r2_point(next, {.5, .5});
        const double root = std::sqrt(u);
        visit(m, t, float(root * (1 - v)), float(root * v));
      }
    }
  }
}

/// Smallest mean free path of the scattering channels; infinite if there is none.
double shortest_length(const std::array<ReducedMedium, 3>& media) {
  double shortest = INFINITY;
  for (const ReducedMedium& medium : media)
    if (medium.absorbed < 1 && medium.mean_free_path > 0)
      shortest = std::min(shortest, length_to_resolve(medium.mean_free_path, medium.absorbed));
  return shortest;
}

}  // namespace

double short_length_of(const Scene& scene, const World& world, const BodyPlan& group) {
  constexpr std::size_t kPlaces = 2048;
  const LocalMedia media(scene, world, scene.media[group.medium]);
  const auto width = float(std::sqrt(group.area / double(kPlaces)) / world.unit);
  std::vector<double> lengths;
  for_places(world, group, kPlaces, [&](std::uint32_t mesh, std::uint32_t triangle, float u, float v) {
    lengths.push_back(shortest_length(media.at(mesh, triangle, u, v, width)) * world.unit);
  });
  std::ranges::sort(lengths);
  return lengths.empty() ? 0 : lengths[lengths.size() / 10];
}

MediaInside media_inside(const PrecomputeInput& input, const Body& body, CubeCentre centre,
                         std::function<HomogeneousMedium(const ReducedMedium&)> convert) {
  const Medium& medium = input.scene.media[body.plan.medium];
  if (!varies_inside(medium)) return {};
  std::function<std::array<ReducedMedium, 3>(const Vec3d&, const NearestSurface::Place&, float)> below;
  if (medium.layers.empty())
    below = [media = std::make_shared<const LocalMedia>(input.scene, input.world, medium)](
                const Vec3d&, const NearestSurface::Place& place, float width) {
      return media->at(place.mesh, place.triangle, place.u, place.v, width);
    };
  else
    below = [media = std::make_shared<const LayeredMedia>(input.scene, input.world, medium, centre)](
                const Vec3d& position, const NearestSurface::Place& place, float width) {
      return media->at(position, place, width);
    };
  return [below = std::move(below), surface = NearestSurface(input.rays, body.plan.meshes),
          convert = std::move(convert)](const Vec3d& position, double width) {
    const std::array<ReducedMedium, 3> reduced = below(position, surface.at(position), float(width));
    return std::array<HomogeneousMedium, 3>{convert(reduced[0]), convert(reduced[1]), convert(reduced[2])};
  };
}

}  // namespace opaline
