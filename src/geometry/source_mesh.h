// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles as they come from a file or a built-in shape, before they are placed, checked and mended.
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

/// Where a mesh without normals is shaded round: across edges between triangles of one smoothing group that bend by
/// no more than the crease angle.
struct Smoothing {
  std::vector<std::uint32_t> groups;  ///< one a triangle, 0 is none; empty: all triangles are one group
  double crease_angle = 180;          ///< degrees

  bool is_everywhere() const { return groups.empty() && crease_angle >= 180; }
  bool is_nowhere() const { return crease_angle <= 0; }
};

struct SourceMesh {
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;  ///< empty, or one a vertex, of any length; zero where there is none
  std::vector<Triangle> triangles;
  std::vector<CornerUvs> uvs;            ///< one a triangle, if asked for and there; else empty
  std::vector<CornerTangents> tangents;  ///< the same
  std::vector<CornerColors> colors;      ///< one a triangle, or empty
  Smoothing smoothing;
  std::size_t collapsed = 0;  ///< triangles left out already for want of three different corners
  std::vector<std::string> warnings;
};

}  // namespace opaline
