// SPDX-License-Identifier: GPL-3.0-or-later
// Each sample's share of the surface: its Voronoi cell on the mesh.
#pragma once

#include <vector>

#include "opaline/core/monitor.h"
#include "sampling/sample_grid.h"
#include "sampling/triangle_list.h"

namespace opaline {

/// Area of the part of the surface that is nearer to each sample than to any other sample of the same sheet,
/// mm^2, in the grid's order. Triangles are halved until they are no larger than the spacing and then clipped
/// by the bisecting planes: the cells are exact and sum to the surface's area.
std::vector<double> surface_shares(const TriangleList& triangles, const SampleGrid& grid, float radius,
                                   Monitor* monitor);

}  // namespace opaline
