// SPDX-License-Identifier: GPL-3.0-or-later
// Equal vertices, edges and triangles of a soup.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/source_mesh.h"

namespace opaline {

/// For each vertex, the first one at exactly the same position (0 and -0 are equal), and with exactly the
/// same normal if given.
std::vector<std::uint32_t> weld(const std::vector<Vec3d>& positions, const std::vector<Vec3f>& normals = {});
std::vector<std::uint32_t> weld(const std::vector<Vec3f>& positions);

/// Moves vertices to the first one differing by rounding alone: by 2^-44 of the largest coordinate along each
/// axis. Moves none if a triangle would lose its area.
void join_seams(SourceMesh& mesh);

/// True for a triangle without area: twice it is at most 1e-12 of the square of its longest side.
bool is_sliver(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Edges of a triangle soup, each with its starting corners. Corner 3 t + k is the edge of triangle t from
/// its vertex k to the next. Edges are in the order of (lower vertex, higher vertex), corners ascend.
class EdgeTable {
 public:
  EdgeTable(const std::vector<Triangle>& triangles, std::size_t vertices);

  /// visit(lower vertex, higher vertex, corners)
  template <class Visitor>
  void for_each(Visitor visit) const {
    std::vector<std::uint32_t> corners;
    for (std::uint32_t lower = 0; lower + 1 < start_.size(); ++lower) {
      for (std::size_t at = start_[lower]; at < start_[lower + 1];) {
        const std::uint32_t higher = entries_[at].higher;
        corners.clear();
        for (; at < start_[lower + 1] && entries_[at].higher == higher; ++at)
          corners.push_back(entries_[at].corner);
        visit(lower, higher, std::span<const std::uint32_t>(corners));
      }
    }
  }

 private:
  struct Entry {
    std::uint32_t higher, corner;
  };
  std::vector<std::uint32_t> start_;  // by lower vertex, into entries_
  std::vector<Entry> entries_;
};

/// For each triangle, true if an earlier one has the same three vertices in any order.
/// in    triangles: with three different vertices; edges: theirs
std::vector<bool> find_duplicates(const std::vector<Triangle>& triangles, const EdgeTable& edges);

}  // namespace opaline
