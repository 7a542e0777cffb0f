// SPDX-License-Identifier: GPL-3.0-or-later
// Flat convex piece of the surface with three or four corners, and its distances to samples.
#pragma once

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "opaline/vec3.h"

namespace opaline {

/// Stored in double for its area; corners in float for distances.
template <std::size_t kCorners>
struct FlatPiece {
  static_assert(kCorners == 3 || kCorners == 4);
  static constexpr std::size_t kCornerCount = kCorners;

  std::array<Vec3d, kCorners> points;
  std::array<Vec3f, kCorners> corners;
  __m128 x, y, z;  // coordinates of the corners
  Vec3f center;
  float extent;  // radius of the ball around the centre, rounded up so floats lose no owner

  explicit FlatPiece(const std::array<Vec3d, kCorners>& points_) : points(points_) {
    Vec3d sum = points[0];
    for (std::size_t k = 1; k < kCorners; ++k) sum = sum + points[k];
    const Vec3d middle = sum / double(kCorners);
    double extent2 = 0;
    for (std::size_t k = 0; k < kCorners; ++k) {
      corners[k] = Vec3f(points[k]);
      extent2 = std::max(extent2, dot(points[k] - middle, points[k] - middle));
    }
    const auto lanes = [this](std::size_t axis) {
      if constexpr (kCorners == 4)
        return _mm_setr_ps(corners[0][axis], corners[1][axis], corners[2][axis], corners[3][axis]);
      else
        return _mm_setr_ps(corners[0][axis], corners[1][axis], corners[2][axis], 0);
    };
    x = lanes(0);
    y = lanes(1);
    z = lanes(2);
    center = Vec3f(middle);
    extent = float(std::sqrt(extent2) * 1.0001);
  }

  /// Squared distances of the corners from p; the last lane is undefined for three corners.
  __m128 squared_distances(const Vec3f& p) const {
    const __m128 dx = _mm_sub_ps(x, _mm_set1_ps(p.x)), dy = _mm_sub_ps(y, _mm_set1_ps(p.y)),
                 dz = _mm_sub_ps(z, _mm_set1_ps(p.z));
    return _mm_add_ps(_mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy)), _mm_mul_ps(dz, dz));
  }

  /// Box of the balls around the corners with these squared radii, slightly enlarged.
  std::array<Vec3f, 2> box_around(__m128 squared) const {
    alignas(16) std::array<float, 4> squares;
    _mm_store_ps(squares.data(), squared);
    Vec3f low = corners[0], high = low;
    for (std::size_t k = 0; k < kCorners; ++k) {
      const Vec3f reach(std::sqrt(squares[k]) * 1.0001f);
      low = component_min(low, corners[k] - reach);
      high = component_max(high, corners[k] + reach);
    }
    return {low, high};
  }
};

/// An origin and two axes in the plane of a piece.
struct PlaneFrame {
  Vec3d origin, x, y;
};

}  // namespace opaline
