// SPDX-License-Identifier: GPL-3.0-or-later
// How messages call a shape.
#pragma once

#include <string>

#include "opaline/scene/scene.h"

namespace opaline {

/// Its file, or "shape 'name'".
inline std::string shape_label(const Shape& shape) {
  if (const auto* file = std::get_if<MeshFile>(&shape.source)) return file->path;
  return "shape '" + shape.name + "'";
}

}  // namespace opaline
