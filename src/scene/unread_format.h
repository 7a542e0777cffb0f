// SPDX-License-Identifier: GPL-3.0-or-later
// Files of other programs that are known, but not read.
#pragma once

#include <string>

namespace opaline {

/// "FBX is not supported; export GLB" by the end of a file's name; empty for every other one.
std::string unread_format(const std::string& path);

}  // namespace opaline
