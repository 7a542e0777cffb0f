// SPDX-License-Identifier: GPL-3.0-or-later
// Checks shared by the readers of all mesh formats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/cut_polygons.h"
#include "geometry/source_mesh.h"
#include "opaline/error.h"
#include "opaline/vec3.h"

namespace opaline {

/// Limit of coordinates: Embree silently drops triangles beyond 1.8e18.
inline constexpr double coordinate_limit = 1e18;

/// Counts vertices with non-finite or too large coordinates, for a single error.
class VertexCheck {
 public:
  /// line: 1-based, 0 in binary files
  void check(const Vec3d& position, std::size_t index, int line);
  void throw_if_any(const std::string& path) const;

 private:
  std::size_t bad_ = 0, first_index_ = 0;
  int first_line_ = 0;
  Vec3d first_;
};

/// A file's normal; zero, none, if it is not finite or too large.
Vec3f usable_normal(const Vec3d& normal);

/// Cuts a polygon, given corner by corner, into the triangles between its first corner and its other edges.
class PolygonFan {
 public:
  /// fans: takes those of more than one triangle, for cut_concave_polygons
  PolygonFan(SourceMesh& mesh, std::vector<Fan>& fans) : mesh_(mesh), fans_(fans) {}

  void add_corner(std::uint32_t vertex) {
    if (corners_ == 0) first_ = vertex;
    if (corners_ >= 2) mesh_.triangles.push_back({first_, last_, vertex});
    last_ = vertex;
    ++corners_;
  }
  /// After the last corner.
  void finish() {
    mesh_.collapsed += corners_ < 3;
    if (corners_ > 3)
      fans_.push_back({std::uint32_t(mesh_.triangles.size() - (corners_ - 2)), std::uint32_t(corners_ - 2)});
  }

 private:
  SourceMesh& mesh_;
  std::vector<Fan>& fans_;
  std::uint32_t first_ = 0, last_ = 0;
  std::size_t corners_ = 0;
};

/// Triangulates concave and duplicate polygons, and warns of self-intersecting ones. The result also applies
/// to other per-corner data of the file.
std::vector<Recut> cut_polygons(const std::string& path, SourceMesh& mesh, const std::vector<Fan>& fans);

/// Copies per-vertex UVs to the corners of all triangles; uvs: empty, or one per vertex.
void give_uvs(SourceMesh& mesh, const std::vector<std::array<float, 2>>& uvs);

/// Bad input at a line of a file.
Error bad_line(const std::string& path, int line, std::string message, std::string expected = {},
               std::string got = {});

/// error "the mesh has no faces" or "no vertices", if so
void require_faces(const std::string& path, std::size_t vertices, std::size_t faces);

}  // namespace opaline
