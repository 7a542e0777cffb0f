// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace opaline {

/// The bytes of a file.
/// error Error{bad_input} naming it: missing, not a file, larger than memory
std::string read_asset_bytes(const std::string& path);

}  // namespace opaline
