// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace opaline {

/// Distance from a surface at which secondary rays start, for single precision: these times the diagonal of the mesh's
/// bounding box and the sum of a position's absolute coordinates.
inline constexpr float kRayOffsetOfSize = 0x1p-18f, kRayOffsetOfPosition = 0x1p-20f;

}  // namespace opaline
