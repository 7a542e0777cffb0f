// SPDX-License-Identifier: GPL-3.0-or-later
// Names of mesh formats, each read by a file in geometry/formats/.
#pragma once

#include <array>
#include <string_view>

namespace opaline {

/// Usual names; in lower case after a dot, they are the files' extensions.
inline constexpr std::array<std::string_view, 6> kMeshFormats{"OBJ", "PLY", "STL", "OFF", "GLB", "glTF"};

}  // namespace opaline
