// SPDX-License-Identifier: GPL-3.0-or-later
// File names with a frame number.
#pragma once

#include <string>

namespace opaline {

/// Replaces the last run of two or more # in a path by the frame's number, padded with zeros:
/// "bunny.####.obj", 7 -> "bunny.0007.obj". Other paths are unchanged.
std::string with_frame(const std::string& path, int frame);

}  // namespace opaline
