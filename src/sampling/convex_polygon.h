// SPDX-License-Identifier: GPL-3.0-or-later
// A convex polygon in a plane, cut by straight lines.
#pragma once

#include <algorithm>
#include <array>

namespace opaline {

struct Point2 {
  double x, y;
};

/// Starts as a triangle; each clip adds at most one corner.
class ConvexPolygon {
 public:
  static constexpr int kMaxCorners = 64;

  void assign(const Point2& a, const Point2& b, const Point2& c) {
    corner_[0] = a;
    corner_[1] = b;
    corner_[2] = c;
    size_ = 3;
  }

  /// Keeps the part where nx x + ny y <= limit.
  void clip(double nx, double ny, double limit) {
    std::array<double, kMaxCorners> side;
    bool outside = false;
    for (int i = 0; i < size_; ++i) {
      side[i] = nx * corner_[i].x + ny * corner_[i].y - limit;
      outside = outside || side[i] > 0;
    }
    if (!outside) return;
    std::array<Point2, kMaxCorners> kept;
    int n = 0;
    for (int i = 0; i < size_; ++i) {
      const int j = i + 1 == size_ ? 0 : i + 1;
      if (side[i] <= 0) kept[n++] = corner_[i];
      if ((side[i] <= 0) != (side[j] <= 0)) {
        const double t = side[i] / (side[i] - side[j]);
        kept[n++] = {corner_[i].x + t * (corner_[j].x - corner_[i].x),
                     corner_[i].y + t * (corner_[j].y - corner_[i].y)};
      }
    }
    std::copy_n(kept.begin(), n, corner_.begin());
    size_ = n;
  }

  void clear() { size_ = 0; }
  bool empty() const { return size_ < 3; }

  /// Area, and area times centroid.
  struct Moments {
    double area = 0, x = 0, y = 0;
  };
  Moments moments() const {
    Moments sum;
    for (int i = 1; i + 1 < size_; ++i) {
      const Point2 &a = corner_[0], &b = corner_[i], &c = corner_[i + 1];
      const double area = 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
      sum.area += area;
      sum.x += area * (a.x + b.x + c.x) / 3;
      sum.y += area * (a.y + b.y + c.y) / 3;
    }
    return sum.area < 0 ? Moments{-sum.area, -sum.x, -sum.y} : sum;
  }

 private:
  std::array<Point2, kMaxCorners> corner_;
  int size_ = 0;
};

}  // namespace opaline
