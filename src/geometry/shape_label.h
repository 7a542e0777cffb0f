// SPDX-License-Identifier: GPL-3.0-or-later
// Name of a shape in messages.
#pragma once

#include <string>

#include "geometry/formats/obj_material.h"
#include "opaline/scene.h"

namespace opaline {

/// Its file, with the part, or "shape 'name'".
inline std::string shape_label(const Shape& shape) {
  const auto* file = std::get_if<MeshFile>(&shape.source);
  if (file == nullptr) return "shape '" + shape.name + "'";
  if (file->part == kNoMaterial) return file->path + ", " + material_label(file->part);
  return file->path + (file->part.empty() ? "" : " part '" + file->part + "'");
}

}  // namespace opaline
