// SPDX-License-Identifier: GPL-3.0-or-later
// Known but unsupported file formats of other programs.
#pragma once

#include <string>

namespace opaline {

/// "FBX is not supported; export GLB" by the file name's extension; empty for all others.
std::string unread_format(const std::string& path);

}  // namespace opaline
