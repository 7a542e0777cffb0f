// SPDX-License-Identifier: GPL-3.0-or-later
// Names of the materials of an OBJ file, as its parts.
#pragma once

#include <string>
#include <string_view>

namespace opaline {

/// The faces in front of the first usemtl, or behind one without a name.
inline constexpr std::string_view kNoMaterial = "(none)";

/// The name behind a usemtl or newmtl, which must be UTF-8 to stand in a scene file: what is not is taken for Latin-1.
std::string obj_material_name(std::string_view text);

}  // namespace opaline
