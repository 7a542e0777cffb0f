// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/surface_shares.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "opaline/core/error.h"
#include "opaline/core/parallel.h"
#include "opaline/sampling/sample_surface.h"
#include "sampling/convex_polygon.h"
#include "sampling/triangle_piece.h"

namespace opaline {
namespace {

struct Share {
  std::uint32_t sample;
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

TrianglePiece whole(const TriangleList& triangles, std::size_t triangle) {
  const TriangleList::Corners t = triangles.corners(triangles.id(triangle));
  return {t.a, t.b, t.c};
}

// Some triangles, or a part of one: about as much work as any other task.
struct Task {
  std::size_t first, last;
  std::optional<TrianglePiece> part;  // of the triangle `first`
};

// Cuts the surface into tasks, by area in units of a mean share and by triangles.
class Tasks {
 public:
  Tasks(const TriangleList& triangles, double mean_share) : mean_share_(mean_share) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const double work = work_on(triangles.area(t));
      if (work > kWork)
        add_parts(t, whole(triangles, t));
      else
        add_triangle(t, work);
    }
  }
  const std::vector<Task>& all() const { return tasks_; }

 private:
  static constexpr double kWork = 512;

  double work_on(double area) const { return 1 + area / mean_share_; }

  void add_triangle(std::size_t triangle, double work) {
    if (tasks_.empty() || tasks_.back().part || filled_ + work > kWork) {
      tasks_.push_back({triangle, triangle, {}});
      filled_ = 0;
    }
    tasks_.back().last = triangle + 1;
    filled_ += work;
  }

  void add_parts(std::size_t triangle, const TrianglePiece& piece) {
    if (work_on(piece.area()) <= kWork)
      tasks_.push_back({triangle, triangle + 1, piece});
    else
      for (const TrianglePiece& half : piece.halves()) add_parts(triangle, half);
  }

  double mean_share_, filled_ = 0;
  std::vector<Task> tasks_;
};

class TriangleDivider {
 public:
  TriangleDivider(const TriangleList& triangles, const SampleGrid& grid, float radius, Monitor* monitor,
                  std::vector<Share>& out)
      : triangles_(triangles), grid_(grid), radius_(radius), monitor_(monitor), out_(out) {}

  // Of the whole triangle, or of a part.
  void divide(std::size_t triangle, const std::optional<TrianglePiece>& part) {
    normal_ = triangles_.geometric_normal(triangle);
    const TrianglePiece piece = whole(triangles_, triangle);
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
          owners_.push_back(half.owner(s, grid_.position(s)));
        }
        remove_dominated(end);
        divide_small(half, end);
        owners_.resize(end);
      }
    }
  }

  // All samples that can be nearest to some point of the piece, and few more: those that no other dominates.
  void find_owners(const TrianglePiece& piece) {
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
  Owner some_near(const TrianglePiece& piece) {
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

  void clip_cells(const TrianglePiece& piece, std::size_t first) {
    // The nearest first: they cut most.
    std::sort(owners_.begin() + std::ptrdiff_t(first), owners_.end(), [](const Owner& x, const Owner& y) {
      return x.sum() != y.sum() ? x.sum() < y.sum() : x.sample < y.sample;
    });
    const std::size_t last = std::min(owners_.size(), first + ConvexPolygon::kMaxCorners - 4);
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
  Vec3f normal_;
  bool any_sheet_ = false;
  std::vector<Owner> owners_;
  std::vector<Site> sites_;
  ConvexPolygon polygon_;
};

}  // namespace

std::vector<SurfaceShare> surface_shares(const TriangleList& triangles, const SampleGrid& grid, float radius,
                                         Monitor* monitor) {
  std::vector<SurfaceShare> shares(grid.size());
  const Tasks tasks(triangles, triangles.area() / double(grid.size()));
  // Blocks bound the memory of the pieces; within one, tasks are summed in order, whatever the threads.
  constexpr std::size_t kBlock = 256;
  std::vector<std::vector<Share>> pieces(std::min(kBlock, tasks.all().size()));
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
  }
  return shares;
}

}  // namespace opaline
