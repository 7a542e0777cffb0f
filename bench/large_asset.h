// SPDX-License-Identifier: GPL-3.0-or-later
// An asset of many triangles, as another program would export it.
#pragma once

#include <string>

namespace opaline {

/// Writes a GLB: a ball of wax, 100 mm across, in six patches with normals whose vertices are split at the borders.
/// out   how many triangles it has: 12 * cells^2
int write_ball_asset(const std::string& path, int cells);

}  // namespace opaline
