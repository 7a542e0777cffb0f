// SPDX-License-Identifier: GPL-3.0-or-later
// Unit normals at vertices.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/source_mesh.h"

namespace opaline {

/// Gives every vertex a unit normal on the outer side of its triangles: its own, normalised, where
/// mesh.normals has one, turned round where it points inward; else the average over the triangles at its
/// position, up to the creases, weighted by their angle there, so it does not depend on how the surface is cut
/// into triangles; without creases those that a fold has reversed do not count. Vertices on creases become several.
/// in    mesh.normals: empty, and no two vertices at one position; or one a vertex, zero where
/// there is none; every triangle has an area
/// from  Thuerrmer & Wuethrich 1998, Computing vertex normals from
/// polygonal facets
void complete_normals(Mesh& mesh, const Smoothing& smoothing, const std::string& name,
                      std::vector<std::string>& warnings);

/// Triangles that a fold has reversed: they face against the surface around each of their vertices, which is by its
/// normals, or where it is faceted by the areas of the triangles there.
std::vector<std::uint32_t> reversed_triangles(const Mesh& mesh);

Vec3d unit_normal(const Mesh& mesh, const Triangle& t);
/// Corner angle of a triangle at its corner k, radians.
double corner_angle(const Mesh& mesh, const Triangle& t, std::size_t k);

}  // namespace opaline
