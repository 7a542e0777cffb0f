// SPDX-License-Identifier: GPL-3.0-or-later
// Name of a shape in messages.
#pragma once

#include <string>

#include "opaline/scene.h"

namespace opaline {

/// Its file, with the part, or "shape 'name'".
inline std::string shape_label(const Shape& shape) {
  if (const auto* file = std::get_if<MeshFile>(&shape.source))
    return file->path + (file->part.empty() ? "" : " part '" + file->part + "'");
  return "shape '" + shape.name + "'";
}

}  // namespace opaline
