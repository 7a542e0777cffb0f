// SPDX-License-Identifier: GPL-3.0-or-later
// Curvature of a surface at its vertices.
#pragma once

#include <span>
#include <vector>

#include "geometry/mesh.h"

namespace opaline {

/// Unit normals at the vertices, averaged over the surface around them by a Gaussian of this standard deviation, in
/// the mesh's unit; less on meshes of very many triangles. Empty if the mesh is faceted.
std::vector<Vec3f> blurred_normals(const Mesh& mesh, double deviation);

/// Mean curvature at each vertex, 1/length, positive where the surface is convex; empty if the mesh is faceted.
/// Creases, whose vertices are split, add none.
/// from  Rusinkiewicz 2004, Estimating curvatures and their derivatives on triangle meshes; the trace of the
///       tensor alone needs no common frame
/// in    normals: one per vertex, or none
std::vector<float> mean_curvature(const Mesh& mesh, std::span<const Vec3f> normals);

}  // namespace opaline
