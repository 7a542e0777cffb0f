// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle or a triangular part of one.
#pragma once

#include "sampling/flat_piece.h"

namespace opaline {

struct TrianglePiece : FlatPiece<3> {
  TrianglePiece(const Vec3d& a, const Vec3d& b, const Vec3d& c) : FlatPiece({a, b, c}) {}

  double area() const {
    const auto& [a, b, c] = points;
    return 0.5 * length(cross(b - a, c - a));
  }
  Vec3d centroid() const { return (points[0] + points[1] + points[2]) / 3.0; }

  PlaneFrame frame() const {
    const auto& [a, b, c] = points;
    const Vec3d ab = b - a, x_axis = normalized(ab), n = normalized(cross(ab, c - a));
    return {a, x_axis, cross(n, x_axis)};
  }

  /// The two halves along the longest side.
  std::array<TrianglePiece, 2> halves() const {
    const auto& [a, b, c] = points;
    const double ab = dot(b - a, b - a), bc = dot(c - b, c - b), ca = dot(a - c, a - c);
    if (ab >= bc && ab >= ca) return halves_between(a, b, c);
    return bc >= ca ? halves_between(b, c, a) : halves_between(c, a, b);
  }

 private:
  static std::array<TrianglePiece, 2> halves_between(const Vec3d& p, const Vec3d& q, const Vec3d& r) {
    const Vec3d middle = 0.5 * (p + q);
    return {TrianglePiece{p, middle, r}, TrianglePiece{middle, q, r}};
  }
};

}  // namespace opaline
