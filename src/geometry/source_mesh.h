// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles from a file or a built-in shape, before placement and checks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "opaline/vec3.h"

namespace opaline {

using Triangle = std::array<std::uint32_t, 3>;

/// Smooth shading of a mesh without normals: across edges between triangles of one smoothing group bent by no
/// more than the crease angle.
struct Smoothing {
  std::vector<std::uint32_t> groups;  ///< one per triangle, 0 is none; empty: all triangles are one group
  double crease_angle = 180;          ///< degrees

  bool is_everywhere() const { return groups.empty() && crease_angle >= 180; }
  bool is_nowhere() const { return crease_angle <= 0; }
};

struct SourceMesh {
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;  ///< empty, or one per vertex, of any length; zero where there is none
  std::vector<Triangle> triangles;
  std::vector<CornerUvs> uvs;            ///< one per triangle, if requested and present; otherwise empty
  std::vector<CornerTangents> tangents;  ///< the same
  std::vector<CornerColors> colors;      ///< one per triangle, or empty
  Smoothing smoothing;
  std::size_t collapsed = 0;  ///< triangles dropped for having fewer than three different corners
  std::vector<std::string> warnings;
};

}  // namespace opaline
