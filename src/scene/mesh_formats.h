// SPDX-License-Identifier: GPL-3.0-or-later
// Names of mesh formats. A file in geometry/formats/ reads each.
#pragma once

#include <array>
#include <string_view>

namespace opaline {

/// As users know them; in lower case the names of their files end so, after a dot.
inline constexpr std::array<std::string_view, 6> kMeshFormats{"OBJ", "PLY", "STL", "OFF", "GLB", "glTF"};

}  // namespace opaline
