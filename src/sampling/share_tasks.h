// SPDX-License-Identifier: GPL-3.0-or-later
// Division of the surface into tasks of similar work.
#pragma once

#include <optional>
#include <vector>

#include "sampling/needle_piece.h"
#include "sampling/triangle_list.h"

namespace opaline {

inline TrianglePiece whole_piece(const TriangleList& triangles, std::size_t triangle) {
  const TriangleList::Corners t = triangles.corners(triangles.id(triangle));
  return {t.a, t.b, t.c};
}

/// Some triangles, or a part of one.
struct Task {
  std::size_t first, last;
  std::optional<TrianglePiece> part = {};  ///< part of the triangle `first`
  std::optional<NeedlePiece> slice = {};   ///< slice of the same triangle, if it is a needle

  bool is_whole() const { return !part && !slice; }
};

/// Divides the surface into tasks, by area in units of a mean cell and by triangles.
class Tasks {
 public:
  Tasks(const TriangleList& triangles, double mean_share, float radius) : mean_share_(mean_share) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const double work = work_on(triangles.area(t));
      if (work <= kWork) {
        add_triangle(t, work);
        continue;
      }
      const TrianglePiece piece = whole_piece(triangles, t);
      if (const std::optional<NeedlePiece> needle = needle_of(piece, radius))
        add_slices(t, *needle);
      else
        add_parts(t, piece);
    }
  }
  const std::vector<Task>& all() const { return tasks_; }

 private:
  static constexpr double kWork = 512;

  double work_on(double area) const { return 1 + area / mean_share_; }

  void add_triangle(std::size_t triangle, double work) {
    if (tasks_.empty() || !tasks_.back().is_whole() || filled_ + work > kWork) {
      tasks_.push_back({triangle, triangle});
      filled_ = 0;
    }
    tasks_.back().last = triangle + 1;
    filled_ += work;
  }

  void add_parts(std::size_t triangle, const TrianglePiece& piece) {
    if (work_on(piece.area()) <= kWork)
      tasks_.push_back({triangle, triangle + 1, piece, {}});
    else
      for (const TrianglePiece& half : piece.halves()) add_parts(triangle, half);
  }

  void add_slices(std::size_t triangle, const NeedlePiece& piece) {
    if (work_on(piece.area()) <= kWork)
      tasks_.push_back({triangle, triangle + 1, {}, piece});
    else
      for (const NeedlePiece& half : piece.halves()) add_slices(triangle, half);
  }

  double mean_share_, filled_ = 0;
  std::vector<Task> tasks_;
};

}  // namespace opaline
