// SPDX-License-Identifier: GPL-3.0-or-later
// Part of a unit cube, and of its faces, behind a plane.
#pragma once

#include <array>

#include "opaline/vec3.h"

namespace opaline {

/// Part of the unit cube centred at 0.
struct PartOfCube {
  double volume = 0;
  Vec3d centre{};
};

/// Part of the cube behind a plane (Scardovelli & Zaleski 2000).
/// in    normal: outward, unit; height: of the plane over the cube's centre, along the normal
PartOfCube part_behind(const Vec3d& normal, double height);

/// Fraction of the unit square centred at 0 behind a line.
/// in    normal: outward, of any length; height: of the line over the square's centre, times that length
double share_behind(const std::array<double, 2>& normal, double height);

}  // namespace opaline
