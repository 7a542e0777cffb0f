// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/solid_lookup.h"

#include <cmath>
#include <cstdint>

#include "image/solid_noise.h"
#include "image/texture_file.h"

namespace opaline {
namespace {

/// One of the three projections of an image along an axis: two axes of the shape's space with their signs, for an image
/// unmirrored from outside, and the weight.
struct Projection {
  std::size_t right, up;
  double right_sign, up_sign, weight;
};

/// Weights by the fourth power of the normal's components.
std::array<Projection, 3> projections(const Vec3d& normal) {
  const auto side = [&](std::size_t c) { return normal[c] < 0 ? -1. : 1.; };
  std::array<Projection, 3> all{{{2, 1, -side(0), 1, 0}, {0, 2, 1, -side(1), 0}, {0, 1, side(2), 1, 0}}};
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) sum += all[c].weight = std::pow(normal[c], 4);
  for (Projection& one : all) one.weight = sum > 0 ? one.weight / sum : 1. / 3;
  return all;
}

TexturePlace projected(const Projection& along, double width, const SolidPlace& solid) {
  const auto on_image = [&](const Vec3d& v) {
    return std::array<float, 2>{float(along.right_sign * v[along.right] / width),
                                float(-along.up_sign * v[along.up] / width)};
  };
  const auto [u, v] = on_image(solid.point);
  return {u, v, on_image(solid.x), on_image(solid.y)};
}

double filter_width(const SolidPlace& solid) {
  return std::sqrt(length(solid.x) * length(solid.y));
}

constexpr double kLeastWeight = 1e-3;  // least weight of a projection

/// Gradient of a channel of solid_value() in the space of the shape, 1/mm.
Vec3d solid_gradient(const Texture& texture, const SolidPlace& solid) {
  if (const SolidNoise* noise = texture.source->noise())
    return noise->gradient(solid.point, filter_width(solid), texture.channel);
  Vec3d sum;
  for (const Projection& along : projections(solid.normal)) {
    if (along.weight < kLeastWeight) continue;
    const auto [right, down] =
        texture.source->image()->slope(projected(along, texture.triplanar_width, solid), texture.channel);
    sum[along.right] += along.right_sign * along.weight * double(right) / texture.triplanar_width;
    sum[along.up] -= along.up_sign * along.weight * double(down) / texture.triplanar_width;
  }
  return sum;
}

}  // namespace

SolidSpace solid_space(const Transform& to_world) {
  const Vec3d across_x = cross(to_world.y, to_world.z), across_y = cross(to_world.z, to_world.x),
              across_z = cross(to_world.x, to_world.y);
  const double volume = dot(to_world.x, across_x);
  SolidSpace space;
  const Vec3d x = across_x / volume, y = across_y / volume, z = across_z / volume;
  if (is_finite(x) && is_finite(y) && is_finite(z)) space = {x, y, z, {}};
  space.origin = to_world.translation;
  return space;
}

std::array<float, 4> solid_value(const Texture& texture, const SolidPlace& solid) {
  if (const SolidNoise* noise = texture.source->noise()) return noise->at(solid.point, filter_width(solid));
  std::array<float, 4> sum{};
  float weights = 0;
  for (const Projection& along : projections(solid.normal)) {
    if (along.weight < kLeastWeight) continue;
    const std::array<float, 4> texel =
        texture.source->image()->at(projected(along, texture.triplanar_width, solid));
    for (std::size_t c = 0; c < 4; ++c) sum[c] += float(along.weight) * texel[c];
    weights += float(along.weight);
  }
  for (float& value : sum) value /= weights;
  return sum;
}

Vec3f solid_rise(const Texture& texture, const SolidSpace& space, const SolidPlace& solid) {
  const Vec3d inside = solid_gradient(texture, solid);
  return Vec3f((space.x * inside.x + space.y * inside.y + space.z * inside.z) * texture.scale.x);
}

}  // namespace opaline
