// SPDX-License-Identifier: GPL-3.0-or-later
// Short ways to make an asset translucent: overrides of a scene by --medium and --size.
#pragma once

#include <string>
#include <vector>

namespace opaline {

/// "marble": all shapes; "wick=marble": one. A preset becomes a medium of its name, unless the scene file has one; a
/// measured one with a satin boundary.
std::vector<std::string> medium_overrides(const std::string& scene, const std::string& option);

/// Sets mm_per_unit for shapes of this largest side together, mm. Reads the scene with the overrides.
/// error as load_scene; Error{bad_input}: there is no shape
std::string size_override(const std::string& scene, const std::vector<std::string>& overrides, double size);

}  // namespace opaline
