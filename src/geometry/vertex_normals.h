// SPDX-License-Identifier: GPL-3.0-or-later
// Unit normals at vertices.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/source_mesh.h"

namespace opaline {

/// Gives every vertex a unit normal on the outside of its triangles: its own normalised one, flipped if it
/// points inward, or the angle-weighted average over the triangles at its position up to the creases,
/// independent of the triangulation. Without creases, the average excludes triangles reversed by a fold.
/// Vertices on creases are split.
/// in    mesh.normals: empty, and no two vertices at one position; or one per vertex, zero if missing; every
///       triangle has an area
/// from  Thuerrmer & Wuethrich 1998, Computing vertex normals from polygonal facets
void complete_normals(Mesh& mesh, const Smoothing& smoothing, const std::string& name,
                      std::vector<std::string>& warnings);

/// Triangles reversed by a fold: opposite to the surface at each of their vertices, by its normals, or by the
/// triangles' areas if the mesh is faceted.
std::vector<std::uint32_t> reversed_triangles(const Mesh& mesh);

Vec3d unit_normal(const Mesh& mesh, const Triangle& t);
/// Corner angle of a triangle at its corner k, radians.
double corner_angle(const Mesh& mesh, const Triangle& t, std::size_t k);

}  // namespace opaline
