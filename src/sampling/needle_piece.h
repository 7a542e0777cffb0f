// SPDX-License-Identifier: GPL-3.0-or-later
// Slice across a triangle far longer than high.
#pragma once

#include <optional>

#include "sampling/triangle_piece.h"

namespace opaline {

/// The quadrilateral a b c d between a short side a b, possibly a point, and a short side c d. Halving a
/// needle at its longest side gives needles of the same shape, in a number quadratic in the ratio of lengths;
/// slicing across is linear in it.
struct NeedlePiece : FlatPiece<4> {
  NeedlePiece(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) : FlatPiece({a, b, c, d}) {}

  double area() const {
    const auto& [a, b, c, d] = points;
    return 0.5 * length(cross(c - a, d - b));
  }

  Vec3d centroid() const {
    const auto& [a, b, c, d] = points;
    const double abc = length(cross(b - a, c - a)), acd = length(cross(c - a, d - a));
    const Vec3d one = (a + b + c) / 3.0, other = (a + c + d) / 3.0;
    return abc + acd > 0 ? (one * abc + other * acd) / (abc + acd) : 0.5 * (one + other);
  }

  PlaneFrame frame() const {
    const auto& [a, b, c, d] = points;
    const Vec3d x_axis = normalized(d - a), n = normalized(cross(c - a, d - b));
    return {a, x_axis, cross(n, x_axis)};
  }

  /// The two halves across the length, or along it if the slice is now wider than long.
  std::array<NeedlePiece, 2> halves() const {
    const auto& [a, b, c, d] = points;
    const double along = std::max(dot(d - a, d - a), dot(c - b, c - b)),
                 across = std::max(dot(b - a, b - a), dot(d - c, d - c));
    if (along >= across) {
      const Vec3d bc = 0.5 * (b + c), da = 0.5 * (d + a);
      return {NeedlePiece{a, b, bc, da}, NeedlePiece{da, bc, c, d}};
    }
    const Vec3d ab = 0.5 * (a + b), cd = 0.5 * (c + d);
    return {NeedlePiece{a, ab, cd, d}, NeedlePiece{ab, b, c, cd}};
  }
};

/// The whole triangle as a slice, if it is large compared with the samples' radius and its longest side
/// exceeds 32 times its height.
inline std::optional<NeedlePiece> needle_of(const TrianglePiece& triangle, float radius) {
  constexpr double kSlender = 32;
  if (triangle.extent <= 3 * radius) return {};
  const auto& [a, b, c] = triangle.points;
  const double ab = dot(b - a, b - a), bc = dot(c - b, c - b), ca = dot(a - c, a - c);
  if (std::max({ab, bc, ca}) <= kSlender * 2 * triangle.area()) return {};  // longest^2 over twice the area
  if (ab <= bc && ab <= ca) return NeedlePiece{c, c, a, b};
  return bc <= ca ? NeedlePiece{a, a, b, c} : NeedlePiece{b, b, c, a};
}

}  // namespace opaline
