// SPDX-License-Identifier: GPL-3.0-or-later
// Convex polygon in a plane, clipped by straight lines.
#pragma once

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace opaline {

struct alignas(16) Point2 {
  double x = 0, y = 0;
};

/// Starts with three or four corners; each clip adds at most one corner.
class ConvexPolygon {
 public:
  static constexpr std::size_t kMostClips = 60;

  template <std::size_t kCorners>
  void assign(const std::array<Point2, kCorners>& outline) {
    static_assert(kCorners <= kBlock);
    std::ranges::copy(outline, corners_[now_].begin());
    size_ = kCorners;
  }

  /// Keeps the part where nx x + ny y <= limit.
  void clip(double nx, double ny, double limit) {
    alignas(16) std::array<double, kRoom> side;
    const std::uint64_t all = (std::uint64_t(1) << size_) - 1, outside = sides(nx, ny, limit, side) & all;
    if (outside == 0) return;
    if (outside == all) return clear();
    // Bit i: one of corner i and the next is outside, the other inside.
    const std::uint64_t crossed = outside ^ (outside >> 1 | (outside & 1) << (size_ - 1));
    const Corners& from = corners_[now_];
    now_ = 1 - now_;
    Corners& to = corners_[now_];
    const std::size_t size = std::exchange(size_, 0);
    for (std::size_t i = 0; i < size; ++i) {
      if (!(outside >> i & 1)) to[size_++] = from[i];
      if (!(crossed >> i & 1)) continue;
      const std::size_t j = i + 1 == size ? 0 : i + 1;
      const double t = side[i] / (side[i] - side[j]);
      to[size_++] = {from[i].x + t * (from[j].x - from[i].x), from[i].y + t * (from[j].y - from[i].y)};
    }
  }

  void clear() { size_ = 0; }
  bool empty() const { return size_ < 3; }

  /// Area, and area times centroid.
  struct Moments {
    double area = 0, x = 0, y = 0;
  };
  Moments moments() const {
    const Point2& a = corners_[now_][0];
    Moments sum;
    for (std::size_t i = 1; i + 1 < size_; ++i) {
      const Point2 &b = corners_[now_][i], &c = corners_[now_][i + 1];
      const double area = 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
      sum.area += area;
      sum.x += area * (a.x + b.x + c.x) / 3;
      sum.y += area * (a.y + b.y + c.y) / 3;
    }
    return sum.area < 0 ? Moments{-sum.area, -sum.x, -sum.y} : sum;
  }

 private:
  static constexpr std::size_t kBlock = 4;  // corners processed together, some of them padding
  static constexpr std::size_t kRoom = kMostClips + kBlock;
  using Corners = std::array<Point2, kRoom>;

  static __m128d load(const Point2& p) { return _mm_load_pd(&p.x); }

  // nx x + ny y - limit of each corner. Bits of those above zero; undefined for padding.
  std::uint64_t sides(double nx, double ny, double limit, std::array<double, kRoom>& side) const {
    const __m128d normal = _mm_setr_pd(nx, ny);
    const auto pair = [&](std::size_t i) {
      const __m128d a = _mm_mul_pd(normal, load(corners_[now_][i])),
                    b = _mm_mul_pd(normal, load(corners_[now_][i + 1])),
                    along = _mm_add_pd(_mm_unpacklo_pd(a, b), _mm_unpackhi_pd(a, b)),
                    s = _mm_sub_pd(along, _mm_set1_pd(limit));
      _mm_store_pd(&side[i], s);
      return std::uint64_t(_mm_movemask_pd(_mm_cmpgt_pd(s, _mm_setzero_pd()))) << i;
    };
    std::uint64_t outside = 0;
    for (std::size_t i = 0; i < size_; i += kBlock) outside |= pair(i) | pair(i + 2);
    return outside;
  }

  std::array<Corners, 2> corners_;
  std::size_t now_ = 0;  // current buffer; clips write to the other
  std::size_t size_ = 0;
};

}  // namespace opaline
