// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/surface_shares.h"

#include <algorithm>
#include <array>
#include <cmath>

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

// A sample that may own part of a piece, and its squared distances from the piece's corners.
struct Owner {
  static constexpr std::uint32_t kNone = ~0u;
  std::uint32_t sample = kNone;
  std::array<float, 3> squared{INFINITY, INFINITY, INFINITY};
  bool is_none() const { return sample == kNone; }
  float sum() const { return squared[0] + squared[1] + squared[2]; }
};

// A sample in the plane of a triangle: `power` is its squared height above the plane plus its squared
// distance from the plane's origin, so that bisectors are lines.
struct Site {
  std::uint32_t sample;
  Point2 place;
  double power;
};

// Part of a triangle, in doubles for its area, with its corners in floats for distances.
struct Piece {
  Vec3d a, b, c;
  std::array<Vec3f, 3> corners;
  Vec3f center;
  float extent;  // radius of the ball around the centre, rounded up so that floats lose no owner

  Piece(const Vec3d& a_, const Vec3d& b_, const Vec3d& c_)
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

  // The two halves along the longest side.
  std::array<Piece, 2> halves() const {
    const double ab = dot(b - a, b - a), bc = dot(c - b, c - b), ca = dot(a - c, a - c);
    if (ab >= bc && ab >= ca) return halves_between(a, b, c);
    return bc >= ca ? halves_between(b, c, a) : halves_between(c, a, b);
  }

 private:
  static std::array<Piece, 2> halves_between(const Vec3d& p, const Vec3d& q, const Vec3d& r) {
    const Vec3d middle = 0.5 * (p + q);
    return {Piece{p, middle, r}, Piece{middle, q, r}};
  }
};

class TriangleDivider {
 public:
  TriangleDivider(const TriangleList& triangles, const SampleGrid& grid, float radius, Monitor* monitor,
                  std::vector<Share>& out)
      : triangles_(triangles), grid_(grid), radius_(radius), monitor_(monitor), out_(out) {}

  void divide(std::size_t triangle) {
    normal_ = triangles_.geometric_normal(triangle);
    const TriangleList::Corners t = triangles_.corners(triangles_.id(triangle));
    const Piece piece(t.a, t.b, t.c);
    // A needle's samples are few and far apart: it is not cut into millions of pieces for them.
    piece_extent_ = std::max(3 * radius_, piece.extent / 64);
    divide_large(piece);
  }

 private:
  // Down to a few spacings, where the owners are looked up once for all the smaller pieces.
  void divide_large(const Piece& piece) {
    if (piece.extent > piece_extent_) {
      for (const Piece& half : piece.halves()) divide_large(half);
      return;
    }
    advance(monitor_, 0);  // one large triangle can be a minute's work
    find_owners(piece);
    divide_small(piece, 0);
  }

  // The owners of this piece stand at the end of owners_, from `first` on.
  void divide_small(const Piece& piece, std::size_t first) {
    const std::size_t count = owners_.size() - first;
    if (count == 1) {
      add(owners_[first].sample, 0.5 * length(cross(piece.b - piece.a, piece.c - piece.a)),
          (piece.a + piece.b + piece.c) / 3.0);
    } else if (count <= kClippedOwners || piece.extent < 0.25f * radius_) {
      clip_cells(piece, first);
    } else {
      const std::size_t end = owners_.size();
      for (const Piece& half : piece.halves()) {
        for (std::size_t i = first; i < end; ++i) {
          const std::uint32_t s = owners_[i].sample;
          owners_.push_back(half.owner(s, grid_.position(s)));
        }
        remove_dominated(end);
        divide_small(half, end);
        owners_.resize(end);
      }
    }
  }

  // All samples that can be nearest to some point of the piece, and few more: those that no other dominates.
  void find_owners(const Piece& piece) {
    const Owner near = some_near(piece);
    // Whoever owns a part is nearer than that one to at least one of the corners.
    Vec3f low = piece.corners[0], high = low;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f reach(std::sqrt(near.squared[k]) * 1.0001f);
      low = component_min(low, piece.corners[k] - reach);
      high = component_max(high, piece.corners[k] + reach);
    }
    owners_.clear();
    grid_.for_cells_between(low, high, [&](const SampleGrid::Coordinates&, const SampleGrid::Cell& cell) {
      for (std::uint32_t s = cell.first; s < cell.first + cell.count; ++s) {
        const Owner o = piece.owner(s, grid_.position(s));
        if (!dominates(near, o) && (any_sheet_ || is_on_sheet(s))) owners_.push_back(o);
      }
      return false;
    });
    remove_dominated(0);
  }

  // A sample of the triangle's sheet: from the cell of the piece's centre, or else the nearest within a reach
  // that grows. A sheet without any sample near falls to the other sheets'.
  Owner some_near(const Piece& piece) {
    any_sheet_ = false;
    Owner near;
    const auto take_nearer = [&](const SampleGrid::Cell& cell) {
      for (std::uint32_t s = cell.first; s < cell.first + cell.count; ++s) {
        const Owner o = piece.owner(s, grid_.position(s));
        if (o.sum() < near.sum() && (any_sheet_ || is_on_sheet(s))) near = o;
      }
      return false;
    };
    if (const SampleGrid::Cell* own = grid_.find_cell(piece.center)) take_nearer(*own);
    for (float reach = radius_; near.is_none(); reach *= 2) {
      any_sheet_ = reach > 64 * (radius_ + piece.extent);
      grid_.for_cells_near(piece.center, reach, take_nearer);
    }
    return near;
  }

  bool is_on_sheet(std::uint32_t sample) const {
    return same_sheet(triangles_.geometric_normal(grid_.place(sample).triangle), normal_);
  }

  // Nearer to all corners, and with that to all that lies between them.
  static bool dominates(const Owner& a, const Owner& b) {
    return a.squared[0] < b.squared[0] && a.squared[1] < b.squared[1] && a.squared[2] < b.squared[2];
  }

  // Removes those of owners_, from `first` on, that another one dominates; it is sought among the nearest to
  // each corner and to the centre.
  void remove_dominated(std::size_t first) {
    std::array<Owner, 4> best;
    best.fill(owners_[first]);
    for (std::size_t i = first + 1; i < owners_.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        if (owners_[i].squared[k] < best[k].squared[k]) best[k] = owners_[i];
      if (owners_[i].sum() < best[3].sum()) best[3] = owners_[i];
    }
    const auto is_dominated = [&best](const Owner& o) {
      return std::ranges::any_of(best, [&o](const Owner& b) { return dominates(b, o); });
    };
    owners_.erase(std::remove_if(owners_.begin() + std::ptrdiff_t(first), owners_.end(), is_dominated),
                  owners_.end());
  }

  void add(std::uint32_t sample, double area, const Vec3d& centroid) {
    out_.push_back({sample, area, (centroid - Vec3d(grid_.position(sample))) * area});
  }

  void clip_cells(const Piece& piece, std::size_t first) {
    // The nearest first: they cut most.
    std::sort(owners_.begin() + std::ptrdiff_t(first), owners_.end(), [](const Owner& x, const Owner& y) {
      return x.sum() != y.sum() ? x.sum() < y.sum() : x.sample < y.sample;
    });
    const std::size_t last = std::min(owners_.size(), first + Polygon::kMaxCorners - 4);
    const Vec3d &a = piece.a, ab = piece.b - a, ac = piece.c - a;
    const Vec3d x_axis = normalized(ab), n = normalized(cross(ab, ac)), y_axis = cross(n, x_axis);
    const auto flat = [&](const Vec3d& p) { return Point2{dot(p - a, x_axis), dot(p - a, y_axis)}; };
    sites_.clear();
    for (std::size_t i = first; i < last; ++i) {
      const Vec3d p(grid_.position(owners_[i].sample));
      sites_.push_back({owners_[i].sample, flat(p), dot(p - a, p - a)});
    }
    const Point2 fa = flat(a), fb = flat(piece.b), fc = flat(piece.c);
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

  static constexpr std::size_t kClippedOwners = 16;

  const TriangleList& triangles_;
  const SampleGrid& grid_;
  float radius_, piece_extent_ = 0;
  Monitor* monitor_;
  std::vector<Share>& out_;
  Vec3f normal_;
  bool any_sheet_ = false;
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
      TriangleDivider divider(triangles, grid, radius, monitor, chunks[chunk]);
      for (std::size_t i = first; i < last; ++i) divider.divide(begin + i);
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
