// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace opaline {

/// Offset of secondary rays from a surface, for single precision: these factors times the diagonal of the
/// mesh's bounding box, and times the sum of a position's absolute coordinates.
inline constexpr float kRayOffsetOfSize = 0x1p-18f, kRayOffsetOfPosition = 0x1p-20f;

}  // namespace opaline
