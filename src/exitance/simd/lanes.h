// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace opaline {

/// Points or nodes that are dealt with at once, whatever the width of the machine's registers.
inline constexpr int kLanes = 16;

}  // namespace opaline
