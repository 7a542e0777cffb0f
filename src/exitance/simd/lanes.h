// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace opaline {

/// Number of points or nodes processed together, for any register width.
inline constexpr int kLanes = 16;

}  // namespace opaline
