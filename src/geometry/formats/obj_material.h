// SPDX-License-Identifier: GPL-3.0-or-later
// Names of the materials of an OBJ file, as its parts.
#pragma once

#include <string>
#include <string_view>

namespace opaline {

/// Faces before the first usemtl, or after one without a name.
inline constexpr std::string_view kNoMaterial = "(none)";

/// "material 'red'", or "faces without a material".
std::string material_label(std::string_view name);

/// Name after a usemtl or newmtl, as UTF-8 for a scene file; invalid UTF-8 is read as Latin-1.
std::string obj_material_name(std::string_view text);

}  // namespace opaline
