// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle mesh as plain data, with the report of its loading.
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

/// Along the surface at a corner of a triangle, as a file has it; of any length, zero where there is none.
struct Tangent {
  Vec3f direction{};
  float side = 1;  ///< 1: direction, the way that v goes and the normal are right-handed; -1: left-handed
};
using CornerTangents = std::array<Tangent, 3>;

/// Linear colours at the corners of a triangle, 0 to 1.
using CornerColors = std::array<RgbF, 3>;

struct Mesh {
  std::vector<Vec3d> positions;                         ///< mm, world space
  std::vector<Vec3f> normals;                           ///< unit, one a vertex; empty: faceted
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  std::vector<CornerUvs> uvs{};            ///< one a triangle, where a texture needs them; else empty
  std::vector<CornerTangents> tangents{};  ///< one a triangle, where they are read and the file has them
  std::vector<CornerColors> colors{};      ///< one a triangle, where the file has vertex colours; else empty
};

/// Defects that were found and repaired in a mesh; counts are of triangles unless stated.
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

/// Enclosed volume of a closed mesh, in cubes of its own unit, >= 0; by the divergence theorem about one of its corners.
double enclosed_volume(const Mesh& mesh);

/// Integrals over a mesh's surface, in powers of the mesh's own unit.
struct MeshMeasures {
  double area = 0, volume = 0;  ///< surface_area, enclosed_volume
  /// Integral of n n^T over the surface, n the unit normal: xx yy zz xy yz zx. The first three sum to the area.
  std::array<double, 6> normal_products{};
  /// Area of needles: triangles with a squared longest side above 64 times their area.
  double needle_area = 0;
};
MeshMeasures measures_of(const Mesh& mesh);

struct Bounds {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
};

/// The smallest box around the vertices; of an empty mesh low > high.
Bounds bounds(const Mesh& mesh);

}  // namespace opaline
