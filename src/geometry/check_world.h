// SPDX-License-Identifier: GPL-3.0-or-later
// Check that single precision represents a world: rays, samples and their octree are floats.
#pragma once

#include <string>

#include "geometry/mesh.h"

namespace opaline {

/// in    mesh: of a world, in its space; diagonal: World::diagonal; unit: World::unit
/// error Error{bad_input} with the name and the bound: the mesh is less than 2^-16 as large as it is far from
///       the middle of the world, less than 2^-30 as large as the world, or so thin that its area changes by
///       more than a tenth where its vertices are rounded to floats
void check_precision(const Mesh& mesh, const std::string& name, double diagonal, double unit);

}  // namespace opaline
