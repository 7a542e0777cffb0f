// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance of far nodes around a point, as a series in the offset.
#pragma once

#include <array>

#include "opaline/vec3.h"

namespace opaline {

/// M(c + e) = value - 2 slope.e + bend |e|^2 + 2 e'He + ..., per channel, in flux units per mm^2: from the
/// second-order series of F(|d - e|^2).
struct Expansion {
  std::array<float, 3> value{}, bend{};
  std::array<std::array<float, 3>, 3> slope{};
  std::array<std::array<float, 6>, 3> hessian{};  ///< H: xx yy zz xy xz yz

  bool empty = true;  ///< nothing added yet

  /// The same function around a point at offset e from the current one.
  Expansion around(const Vec3f& e) const;
};

}  // namespace opaline
