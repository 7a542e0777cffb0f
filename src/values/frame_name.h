// SPDX-License-Identifier: GPL-3.0-or-later
// Names of files that differ from frame to frame.
#pragma once

#include <string>

namespace opaline {

/// The last run of two or more # in a path as the frame's number, with zeros in front to fill them:
/// "bunny.####.obj", 7 -> "bunny.0007.obj". Other paths stay as they are.
std::string with_frame(const std::string& path, int frame);

}  // namespace opaline
