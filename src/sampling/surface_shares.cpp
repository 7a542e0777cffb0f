// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/surface_shares.h"

#include <array>

#include "opaline/core/error.h"
#include "opaline/core/parallel.h"
#include "opaline/sampling/sample_surface.h"

namespace opaline {
namespace {

struct Point2 {
  double x, y;
};

// A convex polygon in the plane of a triangle.
class Polygon {
 public:
  static constexpr int kMaxCorners = 64;

  void assign(const Point2& a, const Point2& b, const Point2& c) {
    corner_[0] = a;
    corner_[1] = b;
    corner_[2] = c;
    size_ = 3;
  }

  // Keeps the part where nx x + ny y <= limit.
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

  // Area, and area times centroid.
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

struct Share {
  std::uint32_t sample;
  double area;
  Vec3d moment;
};

// A sample that may own part of a piece.
struct Owner {
  float distance2;  // to the piece's centre
  std::uint32_t sample;
};

// A sample in the plane of a triangle: `power` is its squared height above the plane plus its squared
// distance from the plane's origin, so that bisectors are lines.
struct Site {
  std::uint32_t sample;
  Point2 place;
  double power;
};

class TriangleDivider {
 public:
  TriangleDivider(const SampleGrid& grid, float radius, Monitor* monitor, std::vector<Share>& out)
      : grid_(grid), radius_(radius), monitor_(monitor), out_(out) {}

  void divide(const TriangleList::Corners& t) {
    normal_ = t.geometric_normal();
    // A needle's samples are few and far apart: it is not cut into millions of pieces for them.
    piece_extent_ = std::max(3 * radius_, ball(t.a, t.b, t.c).extent / 64);
    divide_large(t.a, t.b, t.c);
  }

 private:
  // The centre of a piece and the radius of the ball around it, rounded up so that floats lose no owner.
  struct Ball {
    Vec3f center;
    float extent;
  };
  static Ball ball(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d center = (a + b + c) / 3.0;
    const double extent2 = std::max(dot(a - center, a - center),
                                    std::max(dot(b - center, b - center), dot(c - center, c - center)));
    return {Vec3f(center), float(std::sqrt(extent2) * 1.0001)};
  }

  // Halves along the longest side; `next` takes each half.
  template <class Next>
  static void halve(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Next& next) {
    const double ab = dot(b - a, b - a), bc = dot(c - b, c - b), ca = dot(a - c, a - c);
    if (ab < bc || ab < ca) return bc >= ca ? halve_first(b, c, a, next) : halve_first(c, a, b, next);
    halve_first(a, b, c, next);
  }
  template <class Next>
  static void halve_first(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Next& next) {
    const Vec3d middle = 0.5 * (a + b);
    next(a, middle, c);
    next(middle, b, c);
  }

  // Down to a few spacings, where the owners are looked up once for all the smaller pieces.
  void divide_large(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Ball piece = ball(a, b, c);
    if (piece.extent > piece_extent_)
      return halve(a, b, c, [this](const auto&... corners) { divide_large(corners...); });
    advance(monitor_, 0);  // one large triangle can be a minute's work
    owners_.clear();
    find_owners(piece);
    divide_small(a, b, c, piece, 0);
  }

  // The owners of this piece stand at the end of owners_, from `first` on.
  void divide_small(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Ball& piece, std::size_t first) {
    const std::size_t count = owners_.size() - first;
    if (count == 1) {
      add(owners_[first].sample, 0.5 * length(cross(b - a, c - a)), (a + b + c) / 3.0);
    } else if (count <= kClippedOwners || piece.extent < 0.25f * radius_) {
      clip_cells(a, b, c, first);
    } else {
      halve(a, b, c, [&](const Vec3d& p, const Vec3d& q, const Vec3d& r) {
        const std::size_t end = owners_.size();
        const Ball half = ball(p, q, r);
        narrow_owners(half, first, end);
        divide_small(p, q, r, half, end);
        owners_.resize(end);
      });
    }
  }

  // All samples that can be nearest to some point of the ball: those within d0 + 2 extent of its centre, d0
  // the distance of the nearest one.
  void find_owners(const Ball& piece) {
    for (float reach = 1.2f * radius_ + 2 * piece.extent;; reach *= 2) {
      owners_.clear();
      // A sheet without any sample near falls to the other sheets'.
      const bool any_sheet = reach > 64 * (radius_ + piece.extent);
      grid_.for_cells_near(piece.center, reach, [&](const SampleGrid::Cell& cell) {
        for (std::uint32_t s = cell.first; s < cell.first + cell.count; ++s)
          if (any_sheet || same_sheet(grid_.geometric_normal(s), normal_))
            owners_.push_back({distance2(grid_.position(s), piece.center), s});
        return false;
      });
      const float needed = reach_of_owners(piece, 0, owners_.size());
      if (owners_.empty() || needed > reach) continue;
      std::erase_if(owners_, [&](const Owner& o) { return o.distance2 > needed * needed; });
      return;
    }
  }

  // Appends those of owners_[first, last) that can own part of the smaller ball.
  void narrow_owners(const Ball& piece, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t s = owners_[i].sample;
      owners_.push_back({distance2(grid_.position(s), piece.center), s});
    }
    const float needed = reach_of_owners(piece, last, owners_.size());
    const auto far = [&](const Owner& o) { return o.distance2 > needed * needed; };
    owners_.erase(std::remove_if(owners_.begin() + std::ptrdiff_t(last), owners_.end(), far), owners_.end());
  }

  float reach_of_owners(const Ball& piece, std::size_t first, std::size_t last) const {
    float nearest2 = std::numeric_limits<float>::infinity();
    for (std::size_t i = first; i < last; ++i) nearest2 = std::min(nearest2, owners_[i].distance2);
    return std::sqrt(nearest2) * 1.0001f + 2 * piece.extent;
  }

  void add(std::uint32_t sample, double area, const Vec3d& centroid) {
    out_.push_back({sample, area, (centroid - Vec3d(grid_.position(sample))) * area});
  }

  static float distance2(const Vec3f& a, const Vec3f& b) { return dot(a - b, a - b); }

  void clip_cells(const Vec3d& a, const Vec3d& b, const Vec3d& c, std::size_t first) {
    std::sort(owners_.begin() + std::ptrdiff_t(first), owners_.end(), [](const Owner& x, const Owner& y) {
      return x.distance2 != y.distance2 ? x.distance2 < y.distance2 : x.sample < y.sample;
    });
    const std::size_t last = std::min(owners_.size(), first + Polygon::kMaxCorners - 4);
    const Vec3d x_axis = normalized(b - a), n = normalized(cross(b - a, c - a)), y_axis = cross(n, x_axis);
    const auto flat = [&](const Vec3d& p) { return Point2{dot(p - a, x_axis), dot(p - a, y_axis)}; };
    sites_.clear();
    for (std::size_t i = first; i < last; ++i) {
      const Vec3d p(grid_.position(owners_[i].sample));
      sites_.push_back({owners_[i].sample, flat(p), dot(p - a, p - a)});
    }
    const Point2 fa = flat(a), fb = flat(b), fc = flat(c);
    for (const Site& site : sites_) {
      polygon_.assign(fa, fb, fc);
      for (const Site& other : sites_) {
        if (&other == &site) continue;
        const double nx = other.place.x - site.place.x, ny = other.place.y - site.place.y;
        // Coincident samples: the first takes all.
        if (nx == 0 && ny == 0 && other.power == site.power && other.sample < site.sample) polygon_.clear();
        polygon_.clip(nx, ny, 0.5 * (other.power - site.power));
        if (polygon_.empty()) break;
      }
      if (polygon_.empty()) continue;
      const Polygon::Moments part = polygon_.moments();
      if (part.area > 0) add(site.sample, part.area, a + (x_axis * part.x + y_axis * part.y) / part.area);
    }
  }

  static constexpr std::size_t kClippedOwners = 28;

  const SampleGrid& grid_;
  float radius_, piece_extent_ = 0;
  Monitor* monitor_;
  std::vector<Share>& out_;
  Vec3f normal_;
  std::vector<Owner> owners_;
  std::vector<Site> sites_;
  Polygon polygon_;
};

}  // namespace

std::vector<SurfaceShare> surface_shares(const TriangleList& triangles, const SampleGrid& grid, float radius,
                                         Monitor* monitor) {
  std::vector<SurfaceShare> shares(grid.size());
  // Blocks bound the memory of the pieces; within one, chunks are summed in order, whatever the threads.
  constexpr std::size_t kBlock = 1 << 16, kChunk = 256;
  std::vector<std::vector<Share>> chunks(chunk_count(kBlock, kChunk));
  for (std::size_t begin = 0; begin < triangles.size(); begin += kBlock) {
    const std::size_t n = std::min(kBlock, triangles.size() - begin);
    parallel_chunks(n, kChunk, [&](std::size_t first, std::size_t last, std::size_t chunk) {
      chunks[chunk].clear();
      TriangleDivider divider(grid, radius, monitor, chunks[chunk]);
      for (std::size_t i = first; i < last; ++i) divider.divide(triangles.corners(triangles.id(begin + i)));
      advance(monitor, last - first);
    });
    for (std::size_t c = 0; c < chunk_count(n, kChunk); ++c)
      for (const Share& share : chunks[c]) {
        shares[share.sample].area += share.area;
        shares[share.sample].moment += share.moment;
      }
  }
  return shares;
}

}  // namespace opaline
