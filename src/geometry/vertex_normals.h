// SPDX-License-Identifier: GPL-3.0-or-later
// Unit normals at vertices.
#pragma once

#include <string>
#include <vector>

#include "opaline/geometry/mesh.h"

namespace opaline {

/// Gives every vertex a unit normal on the outer side of its triangles: its own, normalised, where
/// mesh.normals has one, turned round where it points inward; else the average over the triangles at its
/// position, weighted by their angle there, so that it does not depend on how the surface is cut into
/// triangles.
/// in    mesh.normals: empty, and no two vertices at one position; or one a vertex, zero where
/// there is none; every triangle has an area
/// from  Thuerrmer & Wuethrich 1998, Computing vertex normals from
/// polygonal facets
void complete_normals(Mesh& mesh, const std::string& name, std::vector<std::string>& warnings);

}  // namespace opaline
