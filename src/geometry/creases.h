// SPDX-License-Identifier: GPL-3.0-or-later
// Normals on both sides of sharp edges.
#pragma once

#include <vector>

#include "geometry/source_mesh.h"

namespace opaline {

/// Gives each vertex without a normal the average over the triangles around it up to the creases, weighted by their
/// angle there; a vertex on a crease becomes one for each side, the new ones behind all others. A crease is an edge
/// between triangles of different smoothing groups, or of none, or that bends by more than the crease angle.
/// in    mesh.normals: one a vertex; missing: which of them are to be found; every triangle has an area
void average_between_creases(Mesh& mesh, const std::vector<bool>& missing, const Smoothing& smoothing);

}  // namespace opaline
