// SPDX-License-Identifier: GPL-3.0-or-later
// The radial profile of a medium in a body, and the expected error of the models there.
#pragma once

#include <optional>
#include <string>

#include "opaline/scene.h"

namespace opaline {

struct BodyModel {
  ChosenProfile profile;
  bool is_chosen = false;  ///< false: named by the scene
  std::string reason;
  /// Rms error of the radiant exitance against random walks over the mean, worst channel; none: unknown, for
  /// profiles named by the scene and for open meshes.
  std::optional<double> expected_error;
  std::optional<double> expected_error_of_diffusion;  ///< the same of Method::volume_diffusion
  bool has_thin_parts = false;  ///< the latter is that of parts much thinner than the body in the mean
};

}  // namespace opaline
