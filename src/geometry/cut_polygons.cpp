// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cut_polygons.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace opaline {
namespace {

// Least area of a fan outside its polygon, over the polygon's; rounding of collinear corners in a file causes
// less.
constexpr double kLeastOutside = 1e-6;

// Maximum comparisons of corners with ears in all polygons of a file together, some seconds.
constexpr std::size_t kMostComparisons = std::size_t(1) << 29;

constexpr double kRounding = 1e-12;  // rounding in a polygon with corners at most 1 from its first one

struct Point {
  double x = 0, y = 0;
};

bool is_same(const Point& a, const Point& b) {
  return std::abs(a.x - b.x) <= kRounding && std::abs(a.y - b.y) <= kRounding;
}

/// Twice the area of the triangle, > 0 if it is counter-clockwise.
double twice_area(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Potential corners inside ears, by squares of the plane.
class CornerGrid {
 public:
  CornerGrid(const std::vector<Point>& points, const std::vector<std::uint32_t>& corners) {
    low_ = high_ = points[0];
    for (const Point& p : points) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
    }
    const double width = high_.x - low_.x, height = high_.y - low_.y;
    side_ = std::max({std::sqrt(width * height / double(corners.size() + 1)),
                      std::max(width, height) / double(corners.size() + 1), 1e-300});
    columns_ = std::size_t(width / side_) + 1;
    start_.assign(columns_ * (std::size_t(height / side_) + 1) + 1, 0);
    for (const std::uint32_t c : corners) ++start_[cell(points[c]) + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    corners_.resize(corners.size());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (const std::uint32_t c : corners) corners_[next[cell(points[c])]++] = c;
  }

  /// True if a corner lies in the squares from low to high; counts the corners tested.
  template <class Predicate>
  bool any(const Point& low, const Point& high, std::size_t& looks, Predicate is_one) const {
    const std::size_t first = cell(low), last = cell(high), across = last % columns_ - first % columns_;
    for (std::size_t row = first; row <= last; row += columns_) {
      looks += 1 + start_[row + across + 1] - start_[row];
      for (std::size_t at = start_[row]; at < start_[row + across + 1]; ++at)
        if (is_one(corners_[at])) return true;
    }
    return false;
  }

 private:
  std::size_t cell(const Point& p) const {
    const auto index = [&](double value, double low, double high) {
      return std::size_t((std::clamp(value, low, high) - low) / side_);
    };
    return index(p.y, low_.y, high_.y) * columns_ + index(p.x, low_.x, high_.x);
  }

  Point low_, high_;
  double side_ = 1;
  std::size_t columns_ = 1;
  std::vector<std::uint32_t> start_, corners_;  // corners of each square, row by row, in order
};

/// Clips the ears of a polygon in the plane, counter-clockwise as a whole.
class EarClipper {
 public:
  EarClipper(std::vector<Point> points, std::size_t& looks)
      : points_(std::move(points)),
        looks_(looks),
        next_(points_.size()),
        previous_(points_.size()),
        clipped_(points_.size()),
        grid_(points_, linked_reflex_corners()) {}

  /// crosses: set where not all of them were ears
  std::vector<Triangle> run(bool& crosses) {
    std::vector<Triangle> triangles;
    std::size_t left = points_.size(), since = 0;
    int leniency = 0;
    for (std::uint32_t at = 1; left > 3;) {
      if (is_ear(at, leniency)) {
        triangles.push_back({previous_[at], at, next_[at]});
        crosses |= leniency > 1;
        clip(at);
        at = next_[next_[at]];  // not adjacent: avoids a fan of slivers
        --left;
        since = 0;
        leniency = 0;
      } else {
        at = next_[at];
        ++looks_;
        if (++since < left) continue;
        since = 0;
        ++leniency;
      }
    }
    const std::uint32_t last = std::uint32_t(std::ranges::find(clipped_, false) - clipped_.begin());
    triangles.push_back({last, next_[last], next_[next_[last]]});
    crosses |= turn(last) < -1e-9 || looks_ > kMostComparisons;
    return triangles;
  }

 private:
  std::vector<std::uint32_t> linked_reflex_corners() {
    const auto count = std::uint32_t(points_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      previous_[next_[i]] = i;
    }
    std::vector<std::uint32_t> reflex;
    for (std::uint32_t i = 0; i < count; ++i)
      if (!(turn(i) > 0)) reflex.push_back(i);
    return reflex;
  }

  double turn(std::uint32_t i) const {
    return twice_area(points_[previous_[i]], points_[i], points_[next_[i]]);
  }

  void clip(std::uint32_t i) {
    clipped_[i] = true;
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
  }

  /// Without a proper ear, clips corners without area, then convex ones, then any, so self-intersecting
  /// polygons terminate.
  bool is_ear(std::uint32_t i, int leniency) {
    if (leniency > 2 || looks_ > kMostComparisons) return true;
    const Point &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
    const double area = twice_area(a, b, c);
    if (leniency == 1)
      return std::abs(area) <=
             kRounding * std::hypot(b.x - a.x, b.y - a.y) * std::hypot(c.x - b.x, c.y - b.y);
    return area > 0 && (leniency > 1 || is_empty(i, a, b, c));
  }

  bool is_empty(std::uint32_t i, const Point& a, const Point& b, const Point& c) {
    const Point low{std::min({a.x, b.x, c.x}) - kRounding, std::min({a.y, b.y, c.y}) - kRounding},
        high{std::max({a.x, b.x, c.x}) + kRounding, std::max({a.y, b.y, c.y}) + kRounding};
    return !grid_.any(low, high, looks_, [&](std::uint32_t j) {
      if (clipped_[j] || j == previous_[i] || j == i || j == next_[i] || turn(j) > 0) return false;
      const Point& p = points_[j];
      if (is_same(p, a) || is_same(p, c)) return false;  // where a bridge to a hole is met twice
      if (is_same(p, b))
        return is_within(points_[previous_[j]], a, b, c) || is_within(points_[next_[j]], a, b, c);
      return std::min({twice_area(a, b, p), twice_area(b, c, p), twice_area(c, a, p)}) >= -kRounding;
    });
  }

  /// True if p lies between the edges at b.
  static bool is_within(const Point& p, const Point& a, const Point& b, const Point& c) {
    return twice_area(a, b, p) > 0 && twice_area(b, c, p) > 0;
  }

  std::vector<Point> points_;
  std::size_t& looks_;
  std::vector<std::uint32_t> next_, previous_;
  std::vector<bool> clipped_;
  CornerGrid grid_;
};

/// The polygon's corners around its first one, at most 1 away along each axis.
void take_corners(const std::vector<Vec3d>& positions, const Triangle* fan, std::size_t count,
                  std::vector<Vec3d>& corners) {
  const Vec3d& first = positions[fan[0][0]];
  corners.assign({{}, positions[fan[0][1]] - first});
  for (std::size_t t = 0; t < count; ++t) corners.push_back(positions[fan[t][2]] - first);
  double extent = 0;
  for (const Vec3d& p : corners) extent = std::max(extent, max_component(component_max(p, -p)));
  if (extent > 0)
    for (Vec3d& p : corners) p = p / extent;
}

/// Twice the sum of the areas.
double total_area(const std::vector<Vec3d>& corners, const std::vector<Triangle>& triangles) {
  double twice = 0;
  for (const auto& [a, b, c] : triangles)
    twice += length(cross(corners[b] - corners[a], corners[c] - corners[a]));
  return twice;
}

/// Measures of the fan around a polygon's first corner, at the origin.
struct FanMeasures {
  Vec3d area_vector;        // twice
  double area = 0;          // twice
  double area_outside = 0;  // twice, of triangles facing opposite to the whole
};

FanMeasures measure_fan(const std::vector<Vec3d>& corners) {
  FanMeasures fan;
  for (std::size_t i = 2; i < corners.size(); ++i) fan.area_vector += cross(corners[i - 1], corners[i]);
  const Vec3d normal = normalized(fan.area_vector);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Vec3d part = cross(corners[i - 1], corners[i]);
    fan.area += length(part);
    fan.area_outside -= std::min(dot(part, normal), 0.);
  }
  return fan;
}

std::vector<Point> projected(const std::vector<Vec3d>& corners, const Vec3d& normal) {
  Vec3d x, y;
  tangent_frame(normal, x, y);
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const Vec3d& p : corners) points.push_back({dot(p, x), dot(p, y)});
  return points;
}

}  // namespace

PolygonCuts cut_concave_polygons(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                                 const std::vector<Fan>& fans) {
  PolygonCuts result;
  std::vector<Vec3d> corners;
  std::size_t looks = 0;
  for (const Fan& fan : fans) {
    take_corners(positions, &triangles[fan.first], fan.count, corners);
    const FanMeasures measures = measure_fan(corners);
    const double area = length(measures.area_vector);
    bool crosses = area < kLeastOutside * measures.area;
    if (!crosses && measures.area_outside > kLeastOutside * area) {
      std::vector<Triangle> ears =
          EarClipper(projected(corners, normalized(measures.area_vector)), looks).run(crosses);
      if (total_area(corners, ears) < measures.area) result.cuts.push_back({fan, std::move(ears)});
    }
    result.crossing += crosses;
  }
  return result;
}

}  // namespace opaline
