// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle or a part of one, and how far the samples are from it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "opaline/core/vec3.h"

namespace opaline {

/// A sample that may own part of a piece, and its squared distances from the piece's corners.
struct Owner {
  static constexpr std::uint32_t kNone = ~0u;
  std::uint32_t sample = kNone;
  std::array<float, 3> squared{INFINITY, INFINITY, INFINITY};
  bool is_none() const { return sample == kNone; }
  float sum() const { return squared[0] + squared[1] + squared[2]; }
};

/// In doubles for its area, with its corners in floats for distances.
struct TrianglePiece {
  Vec3d a, b, c;
  std::array<Vec3f, 3> corners;
  Vec3f center;
  float extent;  // radius of the ball around the centre, rounded up so that floats lose no owner

  TrianglePiece(const Vec3d& a_, const Vec3d& b_, const Vec3d& c_)
      : a(a_), b(b_), c(c_), corners{Vec3f(a), Vec3f(b), Vec3f(c)} {
    const Vec3d middle = (a + b + c) / 3.0;
    const double extent2 =
        std::max({dot(a - middle, a - middle), dot(b - middle, b - middle), dot(c - middle, c - middle)});
    center = Vec3f(middle);
    extent = float(std::sqrt(extent2) * 1.0001);
  }

  Owner owner(std::uint32_t sample, const Vec3f& p) const {
    Owner owner{sample, {}};
    for (std::size_t k = 0; k < 3; ++k) owner.squared[k] = dot(corners[k] - p, corners[k] - p);
    return owner;
  }

  double area() const { return 0.5 * length(cross(b - a, c - a)); }

  /// The two halves along the longest side.
  std::array<TrianglePiece, 2> halves() const {
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
