// SPDX-License-Identifier: GPL-3.0-or-later
// Division of a triangle into the parts owned by each sample.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "opaline/monitor.h"
#include "sampling/convex_polygon.h"
#include "sampling/needle_piece.h"
#include "sampling/owners.h"
#include "sampling/sample_grid.h"
#include "sampling/sample_surface.h"
#include "sampling/share_tasks.h"
#include "sampling/triangle_list.h"

namespace opaline {

/// Part of a triangle belonging to a sample.
struct Share {
  std::uint32_t sample, triangle;
  double area;
  Vec3d moment;
};

// A sample in the plane of a triangle: `power` is its squared height above the plane plus its squared
// distance from the plane's origin, so bisectors are lines.
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

  // Divides the task's part of a triangle, or the whole triangle.
  void divide(std::size_t triangle, const Task& task) {
    triangle_ = std::uint32_t(triangle);
    normal_ = triangles_.geometric_normal(triangle);
    if (task.slice) return divide_needle(*task.slice);
    const TrianglePiece piece = whole_piece(triangles_, triangle);
    if (const std::optional<NeedlePiece> needle = needle_of(piece, radius_)) return divide_needle(*needle);
    piece_extent_ = std::max(few_spacings(), piece.extent / 64);
    divide_large(task.part ? *task.part : piece);
  }

 private:
  // Recursion down to a few spacings, with one owner search for all smaller pieces.
  void divide_large(const TrianglePiece& piece) {
    if (piece.extent > piece_extent_) {
      for (const TrianglePiece& half : piece.halves()) divide_large(half);
      return;
    }
    advance(monitor_, 0);  // one large triangle can take a minute
    find_owners(piece, kAll);
    divide_small(piece, 0);
  }

  // A needle's samples may be far apart or crowded: it is sliced until a slice has few of them.
  void divide_needle(const NeedlePiece& piece) {
    if (!find_owners(piece, piece.extent > few_spacings() ? kFewOwners : kAll)) {
      for (const NeedlePiece& half : piece.halves()) divide_needle(half);
      return;
    }
    advance(monitor_, 0);
    divide_small(piece, 0);
  }

  // The owners of this piece are at the end of owners_, from `first` on.
  template <class Piece>
  void divide_small(const Piece& piece, std::size_t first) {
    const std::size_t count = owners_.size() - first;
    if (count == 1) {
      add(owners_[first].sample, piece.area(), piece.centroid());
    } else if (count <= kClippedOwners || piece.extent < 0.25f * radius_) {
      clip_cells(piece, first);
    } else {
      const std::size_t end = owners_.size();
      for (const Piece& half : piece.halves()) {
        for (std::size_t i = first; i < end; ++i) {
          const std::uint32_t s = owners_[i].sample;
          owners_.push_back(make_owner(half, s, grid_.position(s)));
        }
        remove_dominated<Piece::kCornerCount>(owners_, end);
        divide_small(half, end);
        owners_.resize(end);
      }
    }
  }

  // Finds all samples nearest to some point of the piece, and few more: the undominated ones. Returns false,
  // with an incomplete result, after examining more than `most` samples.
  template <class Piece>
  bool find_owners(const Piece& piece, std::size_t most) {
    const Owner near = some_near(piece);
    // An owner of a part is nearer than that one to at least one of the corners.
    const auto [low, high] = piece.box_around(near.squared);
    owners_.clear();
    std::size_t seen = 0;
    grid_.for_cells_between(low, high, [&](const SampleGrid::Coordinates&, const SampleGrid::Cell& cell) {
      seen += cell.count;
      if (seen > most) return true;
      for (std::uint32_t s = cell.first; s < cell.first + cell.count; ++s) {
        const Owner owner = make_owner(piece, s, grid_.position(s));
        if (!dominates<Piece::kCornerCount>(near.squared, owner.squared) && (any_sheet_ || is_on_sheet(s)))
          owners_.push_back(owner);
      }
      return false;
    });
    if (seen > most) return false;
    remove_dominated<Piece::kCornerCount>(owners_, 0);
    return true;
  }

  // A nearby sample of the triangle's sheet: from the cell of the piece's centre, or the nearest within a
  // growing reach. A sheet without nearby samples is assigned to other sheets' samples.
  template <class Piece>
  Owner some_near(const Piece& piece) {
    any_sheet_ = false;
    Owner near;
    const auto take_nearer = [&](const SampleGrid::Cell& cell) {
      for (std::uint32_t s = cell.first; s < cell.first + cell.count; ++s) {
        const Owner o = make_owner(piece, s, grid_.position(s));
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

  template <class Piece>
  void clip_cells(const Piece& piece, std::size_t first) {
    nearest_first(owners_, first, sorted_);
    if (sorted_.size() > ConvexPolygon::kMostClips) sorted_.resize(ConvexPolygon::kMostClips);
    const PlaneFrame frame = piece.frame();
    const Vec3d& a = frame.origin;
    const auto flat = [&](const Vec3d& p) { return Point2{dot(p - a, frame.x), dot(p - a, frame.y)}; };
    std::array<Point2, Piece::kCornerCount> outline;
    std::ranges::transform(piece.points, outline.begin(), flat);
    sites_.clear();
    for (const std::uint64_t owner : sorted_) {
      const auto sample = std::uint32_t(owner);
      const Vec3d p(grid_.position(sample));
      sites_.push_back({sample, flat(p), dot(p - a, p - a)});
    }
    for (const Site& site : sites_) {
      polygon_.assign(outline);
      for (const Site& other : sites_) {
        if (&other == &site) continue;
        const double nx = other.place.x - site.place.x, ny = other.place.y - site.place.y;
        // Coincident samples: the first owns everything.
        if (nx == 0 && ny == 0 && other.power == site.power && other.sample < site.sample) polygon_.clear();
        polygon_.clip(nx, ny, 0.5 * (other.power - site.power));
        if (polygon_.empty()) break;
      }
      if (polygon_.empty()) continue;
      const ConvexPolygon::Moments part = polygon_.moments();
      if (part.area > 0) add(site.sample, part.area, a + (frame.x * part.x + frame.y * part.y) / part.area);
    }
  }

  // Size of pieces with one owner search for all smaller ones.
  float few_spacings() const { return 3 * radius_; }

  static constexpr std::size_t kClippedOwners = 16;
  static constexpr std::size_t kFewOwners = 128, kAll = ~std::size_t(0);

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

}  // namespace opaline
