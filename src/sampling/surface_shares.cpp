// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/surface_shares.h"

#include <algorithm>
#include <optional>
#include <span>

#include "opaline/core/error.h"
#include "opaline/core/parallel.h"
#include "opaline/sampling/sample_surface.h"
#include "sampling/convex_polygon.h"
#include "sampling/owners.h"
#include "sampling/share_tasks.h"
#include "sampling/triangle_piece.h"

namespace opaline {
namespace {

struct Share {
  std::uint32_t sample, triangle;
  double area;
  Vec3d moment;
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
  TriangleDivider(const TriangleList& triangles, const SampleGrid& grid, float radius, Monitor* monitor,
                  std::vector<Share>& out)
      : triangles_(triangles), grid_(grid), radius_(radius), monitor_(monitor), out_(out) {}

  // Of the whole triangle, or of a part.
  void divide(std::size_t triangle, const std::optional<TrianglePiece>& part) {
    triangle_ = std::uint32_t(triangle);
    normal_ = triangles_.geometric_normal(triangle);
    const TrianglePiece piece = whole_piece(triangles_, triangle);
    // A needle's samples are few and far apart: it is not cut into millions of pieces for them.
    piece_extent_ = std::max(3 * radius_, piece.extent / 64);
    divide_large(part ? *part : piece);
  }

 private:
  // Down to a few spacings, where the owners are looked up once for all the smaller pieces.
  void divide_large(const TrianglePiece& piece) {
    if (piece.extent > piece_extent_) {
      for (const TrianglePiece& half : piece.halves()) divide_large(half);
      return;
    }
    advance(monitor_, 0);  // one large triangle can be a minute's work
    find_owners(piece);
    divide_small(piece, 0);
  }

  // The owners of this piece stand at the end of owners_, from `first` on.
  void divide_small(const TrianglePiece& piece, std::size_t first) {
    const std::size_t count = owners_.size() - first;
    if (count == 1) {
      add(owners_[first].sample, piece.area(), (piece.a + piece.b + piece.c) / 3.0);
    } else if (count <= kClippedOwners || piece.extent < 0.25f * radius_) {
      clip_cells(piece, first);
    } else {
      const std::size_t end = owners_.size();
      for (const TrianglePiece& half : piece.halves()) {
        for (std::size_t i = first; i < end; ++i) {
          const std::uint32_t s = owners_[i].sample;
          owners_.emplace_back(s, half.squared_distances(grid_.position(s)));
        }
        remove_dominated(owners_, end);
        divide_small(half, end);
        owners_.resize(end);
      }
    }
  }

  // All samples that can be nearest to some point of the piece, and few more: those that no other dominates.
  void find_owners(const TrianglePiece& piece) {
    const Owner near = some_near(piece);
    // Whoever owns a part is nearer than that one to at least one of the corners.
    const auto [low, high] = piece.box_around(near.squared);
    owners_.clear();
    grid_.for_cells_between(low, high, [&](const SampleGrid::Coordinates&, const SampleGrid::Cell& cell) {
      for (std::uint32_t s = cell.first; s < cell.first + cell.count; ++s) {
        const __m128 squared_distances = piece.squared_distances(grid_.position(s));
        if (!dominates(near.squared, squared_distances) && (any_sheet_ || is_on_sheet(s)))
          owners_.emplace_back(s, squared_distances);
      }
      return false;
    });
    remove_dominated(owners_, 0);
  }

  // A sample of the triangle's sheet: from the cell of the piece's centre, or else the nearest within a reach
  // that grows. A sheet without any sample near falls to the other sheets'.
  Owner some_near(const TrianglePiece& piece) {
    any_sheet_ = false;
    Owner near;
    const auto take_nearer = [&](const SampleGrid::Cell& cell) {
      for (std::uint32_t s = cell.first; s < cell.first + cell.count; ++s) {
        const Owner o(s, piece.squared_distances(grid_.position(s)));
        if (o.sum < near.sum && (any_sheet_ || is_on_sheet(s))) near = o;
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

  void add(std::uint32_t sample, double area, const Vec3d& centroid) {
    out_.push_back({sample, triangle_, area, (centroid - Vec3d(grid_.position(sample))) * area});
  }

  void clip_cells(const TrianglePiece& piece, std::size_t first) {
    nearest_first(owners_, first, sorted_);
    if (sorted_.size() > ConvexPolygon::kMostClips) sorted_.resize(ConvexPolygon::kMostClips);
    const Vec3d &a = piece.a, ab = piece.b - a, ac = piece.c - a;
    const Vec3d x_axis = normalized(ab), n = normalized(cross(ab, ac)), y_axis = cross(n, x_axis);
    const auto flat = [&](const Vec3d& p) { return Point2{dot(p - a, x_axis), dot(p - a, y_axis)}; };
    sites_.clear();
    for (const std::uint64_t owner : sorted_) {
      const auto sample = std::uint32_t(owner);
      const Vec3d p(grid_.position(sample));
      sites_.push_back({sample, flat(p), dot(p - a, p - a)});
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
      const ConvexPolygon::Moments part = polygon_.moments();
      if (part.area > 0) add(site.sample, part.area, a + (x_axis * part.x + y_axis * part.y) / part.area);
    }
  }

  static constexpr std::size_t kClippedOwners = 16;

  const TriangleList& triangles_;
  const SampleGrid& grid_;
  float radius_, piece_extent_ = 0;
  Monitor* monitor_;
  std::vector<Share>& out_;
  std::uint32_t triangle_ = 0;
  Vec3f normal_;
  bool any_sheet_ = false;
  std::vector<Owner> owners_;
  std::vector<std::uint64_t> sorted_;  // by nearest_first
  std::vector<Site> sites_;
  ConvexPolygon polygon_;
};

/// Barycentrics of places in a triangle's plane.
class Barycentrics {
 public:
  explicit Barycentrics(const TriangleList::Corners& t) : origin_(t.a) {
    const Vec3d ab = t.b - t.a, ac = t.c - t.a, normal = cross(ab, ac);
    const double scale = dot(normal, normal) > 0 ? 1 / dot(normal, normal) : 0;
    along_u_ = cross(ac, normal) * scale;
    along_v_ = cross(normal, ab) * scale;
  }
  float u(const Vec3d& p) const { return float(dot(p - origin_, along_u_)); }
  float v(const Vec3d& p) const { return float(dot(p - origin_, along_v_)); }

 private:
  Vec3d origin_, along_u_, along_v_;
};

/// Sums the shares of each sample, in place; how many samples there are.
std::size_t merge_by_sample(std::span<Share> shares) {
  constexpr std::size_t kFew = 64;
  const bool sorted = shares.size() > kFew;  // then a sample's are neighbours
  if (sorted) std::ranges::stable_sort(shares, {}, &Share::sample);
  std::size_t count = 0;
  for (const Share& share : shares) {
    std::size_t i = sorted && count > 0 ? count - 1 : 0;
    while (i < count && shares[i].sample != share.sample) ++i;
    if (i == count) {
      shares[count++] = share;
    } else {
      shares[i].area += share.area;
      shares[i].moment += share.moment;
    }
  }
  return count;
}

/// The pieces of one triangle, whose shares are used up.
void add_pieces(const TriangleList& triangles, const SampleGrid& grid, std::span<Share> shares,
                std::vector<SurfacePiece>& pieces) {
  const std::uint32_t triangle = shares[0].triangle;
  const Barycentrics at(triangles.corners(triangles.id(triangle)));
  const double whole = triangles.area(triangle);
  for (const Share& sum : shares.first(merge_by_sample(shares))) {
    if (!(sum.area > 0)) continue;
    const Vec3d middle = Vec3d(grid.position(sum.sample)) + sum.moment / sum.area;
    pieces.push_back({triangle, sum.sample, float(sum.area / whole), at.u(middle), at.v(middle)});
  }
}

}  // namespace

std::vector<SurfaceShare> surface_shares(const TriangleList& triangles, const SampleGrid& grid, float radius,
                                         Monitor* monitor, std::vector<SurfacePiece>* kept) {
  std::vector<SurfaceShare> shares(grid.size());
  const Tasks tasks(triangles, triangles.area() / double(grid.size()));
  // Blocks bound the memory of the pieces; within one, tasks are summed in order, whatever the threads.
  constexpr std::size_t kBlock = 256;
  std::vector<std::vector<Share>> pieces(std::min(kBlock, tasks.all().size()));
  std::vector<std::vector<SurfacePiece>> kept_pieces(kept != nullptr ? pieces.size() : 0);
  for (std::size_t begin = 0; begin < tasks.all().size(); begin += kBlock) {
    const std::span<const Task> block =
        std::span(tasks.all()).subspan(begin, std::min(kBlock, tasks.all().size() - begin));
    parallel_chunks(block.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      const Task& task = block[i];
      pieces[i].clear();
      TriangleDivider divider(triangles, grid, radius, monitor, pieces[i]);
      for (std::size_t t = task.first; t < task.last; ++t) divider.divide(t, task.part);
      advance(monitor, task.part ? 0 : task.last - task.first);
    });
    for (std::size_t i = 0; i < block.size(); ++i)
      for (const Share& share : pieces[i]) {
        shares[share.sample].area += share.area;
        shares[share.sample].moment += share.moment;
      }
    if (kept == nullptr) continue;
    parallel_chunks(block.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      kept_pieces[i].clear();
      const std::span<Share> all = pieces[i];
      for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
        while (end < all.size() && all[end].triangle == all[first].triangle) ++end;
        add_pieces(triangles, grid, all.subspan(first, end - first), kept_pieces[i]);
      }
    });
    for (std::size_t i = 0; i < block.size(); ++i)
      kept->insert(kept->end(), kept_pieces[i].begin(), kept_pieces[i].end());
  }
  return shares;
}

}  // namespace opaline
