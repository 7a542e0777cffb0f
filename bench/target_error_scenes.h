// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes that the prediction of errors was not tuned on.
#pragma once

#include <string>
#include <vector>

#include "opaline/scene.h"

namespace opaline {

struct NamedScene {
  std::string name;
  Scene scene;  ///< 128 pixels wide, opaque surfaces black
};

/// Shapes, media and lights that no scene of the repository has. Meshes are written into the folder.
std::vector<NamedScene> calibration_scenes(const std::string& folder);

}  // namespace opaline
