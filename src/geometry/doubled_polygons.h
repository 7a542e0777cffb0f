// SPDX-License-Identifier: GPL-3.0-or-later
// Duplicate polygons in a file.
#pragma once

#include <vector>

#include "geometry/cut_polygons.h"

namespace opaline {

/// Unifies the triangulations of polygons with the same corners, in any rotation or direction, so their
/// triangles become duplicates. A quad also given as two triangles uses their diagonal.
/// in    cuts: of cut_concave_polygons, in the order of the fans; equal positions are one corner
/// out   cuts, with those of later polygons added or replaced
void cut_doubles_alike(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                       const std::vector<Fan>& fans, std::vector<Recut>& cuts);

}  // namespace opaline
