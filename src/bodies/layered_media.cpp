// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies/layered_media.h"

#include <algorithm>
#include <cmath>

namespace opaline {

namespace {

/// Depths of a cube below the surface.
struct Depths {
  double first, last;
};

Depths depths_of(double depth, double width, CubeCentre centre) {
  constexpr double kLeast = 1e-6;  // widths
  const double half = centre == CubeCentre::inside ? std::min(.5 * width, depth) : .5 * width;
  const double first = std::max(0., depth - half);
  return {first, std::max(depth + half, first + kLeast * width)};
}

}  // namespace

std::array<ReducedMedium, 3> reduced_media(const PhysicalMedium& medium, double eta, double unit) {
  std::array<ReducedMedium, 3> media;
  for (std::size_t c = 0; c < 3; ++c) {
    constexpr double kEmpty = 1e-12;  // 1/mm
    const double extinction = std::max(kEmpty, medium.sigma_a[c] + medium.sigma_s_prime[c]);
    media[c] = {1 / (extinction * unit), std::min(1., medium.sigma_a[c] / extinction), eta};
  }
  return media;
}

LayeredMedia::LayeredMedia(const Scene& scene, const World& world, const Medium& medium, CubeCentre centre)
    : world_(world), medium_(medium), centre_(centre), textures_(scene, world) {}

std::array<ReducedMedium, 3> LayeredMedia::at(const Vec3d& position, const NearestSurface::Place& nearest,
                                              float width) const {
  const SurfacePoint point =
      surface_point(world_.meshes[nearest.mesh], nearest.triangle, nearest.u, nearest.v);
  Footprint footprint;
  tangent_frame(point.geometric, footprint.x, footprint.y);
  footprint.x *= width;
  footprint.y *= width;
  const SurfaceTextures::Place place =
      textures_.place(nearest.mesh, nearest.triangle, nearest.u, nearest.v, footprint);
  const bool is_outside = dot(position - Vec3d(point.position), Vec3d(point.geometric)) > 0;
  const auto [first, last] =
      depths_of(is_outside ? -nearest.distance : nearest.distance, double(width), centre_);
  Rgb sigma_a{}, sigma_s_prime{};
  double top = 0;
  for (std::size_t i = 0; i < medium_.layers.size() && top < last; ++i) {
    const MediumLayer& layer = medium_.layers[i];
    const auto factor = double(factor_at(pointer_to(layer.thickness_texture), place));
    const bool is_last = i + 1 == medium_.layers.size();
    const double bottom = is_last ? last : top + layer.thickness * factor / world_.unit;
    const double share = std::max(0., std::min(bottom, last) - std::max(top, first)) / (last - first);
    sigma_a += layer.coefficients.sigma_a * share;
    sigma_s_prime += layer.coefficients.sigma_s_prime * share;
    top = bottom;
  }
  return reduced_media({sigma_a, sigma_s_prime}, medium_.eta, world_.unit);
}

}  // namespace opaline
