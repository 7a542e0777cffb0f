// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons that a file gives more than once.
#pragma once

#include <vector>

#include "geometry/cut_polygons.h"

namespace opaline {

/// Cuts of polygons with the same corners become alike, whichever corner they start at and whichever way they run, so
/// that their triangles are duplicates of each other. A quad that the file also gives as two triangles is cut as they are.
/// in    cuts: of cut_concave_polygons, in the order of the fans; positions that are equal are one corner
/// out   cuts with those of the later polygons added or replaced
void cut_doubles_alike(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                       const std::vector<Fan>& fans, std::vector<Recut>& cuts);

}  // namespace opaline
