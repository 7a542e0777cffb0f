// SPDX-License-Identifier: GPL-3.0-or-later
// Environment maps beside the scene, offered by the page.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace opaline {

/// Environment maps in folders and their direct subfolders: paths by names relative to their folder, at most 64. EXRs of
/// other shapes than lat-long images are left out, by their headers.
/// in    folders: searched in this order, up to 500 entries; missing ones are empty
std::map<std::string, std::string> environments_in(const std::vector<std::string>& folders);

}  // namespace opaline
