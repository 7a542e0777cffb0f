// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle or a part of one, and how far the samples are from it.
#pragma once

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "opaline/core/vec3.h"

namespace opaline {

/// In doubles for its area, with its corners in floats for distances.
struct TrianglePiece {
  Vec3d a, b, c;
  std::array<Vec3f, 3> corners;
  __m128 x, y, z;  // of the corners
  Vec3f center;
  float extent;  // radius of the ball around the centre, rounded up so that floats lose no owner

  TrianglePiece(const Vec3d& a_, const Vec3d& b_, const Vec3d& c_)
      : a(a_), b(b_), c(c_), corners{Vec3f(a), Vec3f(b), Vec3f(c)} {
    x = _mm_setr_ps(corners[0].x, corners[1].x, corners[2].x, 0);
    y = _mm_setr_ps(corners[0].y, corners[1].y, corners[2].y, 0);
    z = _mm_setr_ps(corners[0].z, corners[1].z, corners[2].z, 0);
    const Vec3d middle = (a + b + c) / 3.0;
    const double extent2 =
        std::max({dot(a - middle, a - middle), dot(b - middle, b - middle), dot(c - middle, c - middle)});
    center = Vec3f(middle);
    extent = float(std::sqrt(extent2) * 1.0001);
  }

  /// Squared distances of the corners from p; the last lane is of no use.
  __m128 squared_distances(const Vec3f& p) const {
    const __m128 dx = _mm_sub_ps(x, _mm_set1_ps(p.x)), dy = _mm_sub_ps(y, _mm_set1_ps(p.y)),
                 dz = _mm_sub_ps(z, _mm_set1_ps(p.z));
    return _mm_add_ps(_mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy)), _mm_mul_ps(dz, dz));
  }

  /// The box of the balls around the corners that have these squared radii, and slightly more.
  std::array<Vec3f, 2> box_around(__m128 squared) const {
    alignas(16) std::array<float, 4> squares;
    _mm_store_ps(squares.data(), squared);
    Vec3f low = corners[0], high = low;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f reach(std::sqrt(squares[k]) * 1.0001f);
      low = component_min(low, corners[k] - reach);
      high = component_max(high, corners[k] + reach);
    }
    return {low, high};
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
