// SPDX-License-Identifier: GPL-3.0-or-later
// Points on a subdivided triangle, and second-order interpolation on one of its parts.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "exitance/surface_cache.h"

namespace opaline {

/// Number of nodes of a triangular lattice with this many segments along each side.
inline std::size_t lattice_size(std::uint32_t segments) {
  return (std::size_t(segments) + 1) * (std::size_t(segments) + 2) / 2;
}

inline std::uint32_t lattice_index(std::uint32_t segments, std::uint32_t i, std::uint32_t j) {
  return j * (2 * segments + 3 - j) / 2 + i;
}

/// A point in one of the cells^2 triangles dividing a triangle. Inverted cells, between three others, have
/// their first corner at (i + 1, j + 1) and opposite axes.
struct CellPlace {
  std::uint32_t i = 0, j = 0;
  bool upright = true;
  float u = 0, v = 0;  // within the cell
  std::uint32_t index(std::uint32_t cells) const { return j * (2 * cells - j) + 2 * i + (upright ? 0 : 1); }
  /// Lattice coordinates of a point of the cell, itself divided into `parts`.
  std::array<std::uint32_t, 2> node(std::uint32_t parts, std::uint32_t di, std::uint32_t dj) const {
    if (upright) return {parts * i + di, parts * j + dj};
    return {parts * (i + 1) - di, parts * (j + 1) - dj};
  }
};

/// Cell containing barycentrics u, v of a triangle divided into cells x cells, and the position within it.
inline CellPlace cell_place(std::uint32_t cells, float u, float v) {
  const float x = std::max(0.0f, u * float(cells)), y = std::max(0.0f, v * float(cells));
  CellPlace place;
  place.i = std::min(std::uint32_t(x), cells - 1);
  place.j = std::min(std::uint32_t(y), cells - 1 - place.i);
  place.u = x - float(place.i), place.v = y - float(place.j);
  place.upright = place.u + place.v <= 1 || place.i + place.j + 1 >= cells;
  if (!place.upright) place.u = 1 - place.u, place.v = 1 - place.v;
  return place;
}

/// sum += w e, quantity by quantity.
inline void add_scaled(Exitance& sum, const Exitance& e, float w) {
  sum.exitance += e.exitance * w;
  sum.irradiance += e.irradiance * w;
  sum.near += e.near * w;
  sum.error += e.error * w;
}

/// Exitance depending on the point's own irradiance, for this irradiance.
inline RgbF own_part(const std::array<float, 3>& own_irradiance, const Exitance& e, const RgbF& irradiance) {
  return RgbF{own_irradiance[0], own_irradiance[1], own_irradiance[2]} * e.near * irradiance;
}

/// Difference of the exitance in the middle of an edge from the mean of its ends, by the slopes there.
inline RgbF rise_between(const SurfaceCache::Vertex& a, const SurfaceCache::Vertex& b) {
  const Vec3f along = b.position - a.position;
  RgbF rise;
  for (std::size_t c = 0; c < 3; ++c) rise[c] = dot(a.slope[c] - b.slope[c], along) / 8;
  return rise;
}

/// Quadratic through the values at the vertices and the midpoints from rise_between.
inline Exitance between_vertices(const SurfaceCache& cache, const SurfaceCache::Patch& patch, float u,
                                 float v) {
  const SurfaceCache::Vertex &a = cache.vertices[patch.vertices[0]], &b = cache.vertices[patch.vertices[1]],
                             &c = cache.vertices[patch.vertices[2]];
  const float w = 1 - u - v;
  Exitance e;
  add_scaled(e, a.value, w);
  add_scaled(e, b.value, u);
  add_scaled(e, c.value, v);
  e.exitance +=
      rise_between(a, b) * (4 * w * u) + rise_between(b, c) * (4 * u * v) + rise_between(c, a) * (4 * v * w);
  return e;
}

/// Six nodes of the quadratic: a cell's corners, and the midpoints of its sides, in the order of
/// SixNodes::offsets.
struct SixNodes {
  static constexpr std::array<std::array<std::uint32_t, 2>, 6> offsets{
      {{0, 0}, {2, 0}, {0, 2}, {1, 0}, {1, 1}, {0, 1}}};
  std::array<float, 6> weights;
  /// Weights of the quadratic interpolation at barycentrics u, v.
  SixNodes(float u, float v) {
    const float w = 1 - u - v;
    weights = {w * (2 * w - 1), u * (2 * u - 1), v * (2 * v - 1), 4 * w * u, 4 * u * v, 4 * v * w};
  }
};

}  // namespace opaline
