// SPDX-License-Identifier: GPL-3.0-or-later
// Files referenced by an asset, inside its folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "opaline/error.h"

namespace opaline {

struct NamedFile {
  std::filesystem::path path;  ///< empty: there is no such file
  std::string warning;         ///< file used instead of a missing path; empty: none
};

/// Bad input: an asset names a file outside of its folder.
struct OutsideAsset : Error {
  using Error::Error;
};

/// Permits files outside of the assets' folders from now on.
void allow_files_outside_assets();
bool are_files_outside_assets_allowed();

/// Finds a file by the name in an asset: relative to `folder`, with slashes or backslashes. If missing, finds
/// the file whose path differs in case only, or, as with paths of another machine, the file of that name in the
/// same folder.
/// in    asset: its folder must contain the file; folder: of the referring file
/// error OutsideAsset naming the asset and the file: it is outside, possibly through a link, and
///       allow_files_outside_assets was not called
NamedFile find_named_file(const std::string& name, const std::string& asset,
                          const std::filesystem::path& folder);

/// In quotes, without control characters.
std::string in_quotes(std::string_view name);

}  // namespace opaline
