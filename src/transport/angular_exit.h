// SPDX-License-Identifier: GPL-3.0-or-later
// Angular distribution of light scattered inside a body.
#pragma once

#include <vector>

#include "opaline/vec3.h"

namespace opaline {

/// Outgoing radiance of a half space in uniform light, relative to isotropic light of the same flux behind
/// the boundary: 1 without absorption; otherwise larger near the horizon, from shallow paths. By reciprocity
/// proportional to the reflected fraction of light incident at that angle.
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
