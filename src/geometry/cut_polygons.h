// SPDX-License-Identifier: GPL-3.0-or-later
// Triangulation of polygons in mesh files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/source_mesh.h"

namespace opaline {

/// A polygon among a reader's triangles: the fan of its first corner.
struct Fan {
  std::uint32_t first = 0, count = 0;  ///< triangles
};

/// Another cut of a fan's polygon.
struct Recut {
  Fan fan;
  std::vector<Triangle> corners;  ///< as many as the fan has; numbers of the polygon's corners
};

struct PolygonCuts {
  std::vector<Recut> cuts;
  std::size_t crossing = 0;  ///< polygons without a triangulation covering them once, within the search limit
};

/// Triangulates polygons not covered by their fans: clips ears of the projection along the mean normal, so a
/// quad is split at its reflex corner. Other polygons keep their fans. A self-intersecting polygon uses the
/// triangulation of the smaller area.
/// in    positions finite; fans of at least two triangles
/// from  Meisters 1975, Polygons have ears; mean normal after Newell
PolygonCuts cut_concave_polygons(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                                 const std::vector<Fan>& fans);

/// Rearranges per-corner values of triangles, such as vertices, for the new triangles.
template <class T>
void recut(const std::vector<Recut>& cuts, std::vector<std::array<T, 3>>& values) {
  std::vector<T> polygon;
  for (const auto& [fan, corners] : cuts) {
    polygon.assign(values[fan.first].begin(), values[fan.first].begin() + 2);
    for (std::size_t t = 0; t < fan.count; ++t) polygon.push_back(values[fan.first + t][2]);
    for (std::size_t t = 0; t < fan.count; ++t)
      for (std::size_t k = 0; k < 3; ++k) values[fan.first + t][k] = polygon[corners[t][k]];
  }
}

}  // namespace opaline
