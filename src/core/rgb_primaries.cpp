// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rgb_primaries.h"

namespace opaline {
namespace {

constexpr ColorMatrix kBradford{{{.8951, .2664, -.1614}, {-.7502, 1.7135, .0367}, {.0389, -.0685, 1.0296}}};

ColorMatrix transposed(const ColorMatrix& m) {
  return {{{m[0].x, m[1].x, m[2].x}, {m[0].y, m[1].y, m[2].y}, {m[0].z, m[1].z, m[2].z}}};
}

ColorMatrix product(const ColorMatrix& a, const ColorMatrix& b) {
  const ColorMatrix columns = transposed(b);
  return transposed({a * columns[0], a * columns[1], a * columns[2]});
}

// By the adjugate: its columns are cross products of the rows.
ColorMatrix inverse(const ColorMatrix& m) {
  const Vec3d x = cross(m[1], m[2]), y = cross(m[2], m[0]), z = cross(m[0], m[1]);
  const double scale = 1 / dot(m[0], x);
  return transposed({x * scale, y * scale, z * scale});
}

// Normalised by the sum, as the y of a primary may be 0.
Vec3d xyz_of(const std::array<double, 2>& xy) {
  return {xy[0], xy[1], 1 - xy[0] - xy[1]};
}

Vec3d white_of(const RgbPrimaries& space) {
  return xyz_of(space.white) * (1 / space.white[1]);
}

ColorMatrix scaled_columns(const ColorMatrix& m, const Vec3d& by) {
  return {m[0] * by, m[1] * by, m[2] * by};
}

ColorMatrix to_xyz(const RgbPrimaries& space) {
  const ColorMatrix primaries = transposed({xyz_of(space.red), xyz_of(space.green), xyz_of(space.blue)});
  return scaled_columns(primaries, inverse(primaries) * white_of(space));
}

}  // namespace

ColorMatrix color_matrix(const RgbPrimaries& from, const RgbPrimaries& to) {
  const Vec3d white_from = kBradford * white_of(from), white_to = kBradford * white_of(to);
  const Vec3d gains{white_to.x / white_from.x, white_to.y / white_from.y, white_to.z / white_from.z};
  const ColorMatrix adapted =
      product(scaled_columns(inverse(kBradford), gains), product(kBradford, to_xyz(from)));
  return product(inverse(to_xyz(to)), adapted);
}

ColorMatrix xyz_to_rgb(const RgbPrimaries& space) {
  return inverse(to_xyz(space));
}

}  // namespace opaline
