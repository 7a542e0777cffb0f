// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle mesh as plain data, with a report of its repairs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "opaline/vec3.h"

namespace opaline {

/// UVs at the corners of a triangle; v upwards.
using CornerUvs = std::array<std::array<float, 2>, 3>;

/// Tangent at a corner of a triangle, from a file; of any length, zero if missing.
struct Tangent {
  Vec3f direction{};
  float side = 1;  ///< handedness of direction, direction of v and normal: 1 right, -1 left
};
using CornerTangents = std::array<Tangent, 3>;

/// Linear colours at the corners of a triangle, 0 to 1.
using CornerColors = std::array<RgbF, 3>;

struct Mesh {
  std::vector<Vec3d> positions;                         ///< mm, world space
  std::vector<Vec3f> normals;                           ///< unit, one per vertex; empty: faceted
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  std::vector<CornerUvs> uvs{};            ///< one per triangle, if a texture needs them; else empty
  std::vector<CornerTangents> tangents{};  ///< one per triangle, if requested and present
  std::vector<CornerColors> colors{};      ///< one per triangle, if the file has vertex colours; else empty
};

/// Repaired defects of a mesh; counts are of triangles unless stated.
struct MeshReport {
  std::size_t zero_area_dropped = 0, duplicates_dropped = 0, flipped = 0;
  std::size_t holes_filled = 0, hole_triangles_added = 0;
  std::size_t open_edges = 0, non_manifold_edges = 0;
  std::vector<std::string> warnings;  ///< one line each, for the user, naming the file or shape
};

struct CheckedMesh {
  Mesh mesh;
  MeshReport report;
};

/// Total area of the triangles, mm^2.
double surface_area(const Mesh& mesh);

/// Enclosed volume of a closed mesh, in cubes of its own unit, >= 0; by the divergence theorem about one of
/// its corners.
double enclosed_volume(const Mesh& mesh);

/// Integrals over a mesh's surface, in powers of the mesh's own unit.
struct MeshMeasures {
  double area = 0, volume = 0;  ///< surface_area, enclosed_volume
  /// Integral of n n^T over the surface, n the unit normal: xx yy zz xy yz zx. The first three sum to the
  /// area.
  std::array<double, 6> normal_products{};
  /// Area of needles: triangles with a squared longest side above 64 times their area.
  double needle_area = 0;
  /// Sum of the areas of the triangles projected along the three axes.
  double projected_area = 0;
};
MeshMeasures measures_of(const Mesh& mesh);

struct Bounds {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
};

/// True if two boxes share a point.
inline bool meet(const Bounds& a, const Bounds& b) {
  return max_component(component_max(a.low, b.low) - component_min(a.high, b.high)) <= 0;
}

/// True if the outer box holds all of the inner one.
inline bool contains(const Bounds& outer, const Bounds& inner) {
  return component_min(outer.low, inner.low) == outer.low &&
         component_max(outer.high, inner.high) == outer.high;
}

/// Bounding box of the vertices; low > high for an empty mesh.
Bounds bounds(const Mesh& mesh);

}  // namespace opaline
