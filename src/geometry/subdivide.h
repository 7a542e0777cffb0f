// SPDX-License-Identifier: GPL-3.0-or-later
// Loop subdivision of coarse meshes.
#pragma once

#include "geometry/source_mesh.h"

namespace opaline {

/// Cuts each triangle in four and smooths the surface. Vertices at the same position are one; edges of one
/// triangle, or of more than two, are kept as curves of their own. Corner data are linear between the given
/// corners. Normals and creases are removed: the surface is smooth.
/// from  Loop 1987, with the weights of Warren 1995: 3 / (8 n), 3 / 16 for n = 3
SourceMesh subdivided(SourceMesh mesh);

}  // namespace opaline
