// SPDX-License-Identifier: GPL-3.0-or-later
// How light scattered inside leaves by angle.
#pragma once

#include <vector>

#include "opaline/core/vec3.h"

namespace opaline {

/// Radiance of what leaves a half space in even light from all around, over that of as much light behind the boundary
/// that comes to it evenly from all sides: 1 where nothing is absorbed, else more towards the horizon, whence light comes
/// that did not go deep. By reciprocity it goes as the share coming back of what enters at that angle.
/// from  HalfSpace; measured against random walks in src/volume/README.md
class AngularExit {
 public:
  /// in    absorbed = 1 - albedo in [0, 1] of R G B; eta, inside over outside, > 0
  AngularExit(const Rgb& absorbed, double eta);

  /// in    cosine: outside, with the normal, [0, 1]
  RgbF at(float cosine) const;

 private:
  std::vector<RgbF> table_;  // at even steps of the cosine outside
};

}  // namespace opaline
