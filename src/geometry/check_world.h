// SPDX-License-Identifier: GPL-3.0-or-later
// Checks a world against single precision, used by rays, samples and their octree.
#pragma once

#include <string>

#include "opaline/geometry/mesh.h"

namespace opaline {

/// in    mesh: of a world, in its space; diagonal: World::diagonal; unit: World::unit
/// error Error{bad_input} with the name and the bound: the mesh is smaller than 2^-16 of its distance from
///       the middle of the world or 2^-30 of the world's size, or so thin that rounding its vertices to
///       floats changes its area by more than a tenth
void check_precision(const Mesh& mesh, const std::string& name, double diagonal, double unit);

}  // namespace opaline
