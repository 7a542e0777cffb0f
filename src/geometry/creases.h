// SPDX-License-Identifier: GPL-3.0-or-later
// Normals on both sides of sharp edges.
#pragma once

#include <vector>

#include "geometry/source_mesh.h"

namespace opaline {

/// Gives each vertex without a normal the average over the triangles around it up to the creases, weighted by
/// angle. A vertex on a crease becomes one vertex per side, the new ones after all others. A crease is an
/// edge between triangles of different smoothing groups or of none, or with a bend above the crease angle.
/// in    mesh.normals: one per vertex; missing: flags of the vertices to complete; every triangle has an area
void average_between_creases(Mesh& mesh, const std::vector<bool>& missing, const Smoothing& smoothing);

}  // namespace opaline
