// SPDX-License-Identifier: GPL-3.0-or-later
// Files that an asset names: they lie in its folder.
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

/// From now on the files that assets name may lie outside of the assets' folders.
void allow_files_outside_assets();
bool are_files_outside_assets_allowed();

/// Finds a file by the name that an asset gives it: relative to `folder`, with slashes or backslashes. Where nothing is
/// there, as under a path of another machine, the file of that name in the same folder.
/// in    asset: in whose folder the file must lie; folder: of the file whose text has the name
/// error OutsideAsset naming the asset and the file: it lies outside, also by way of a link, and
///       allow_files_outside_assets was not called
NamedFile find_named_file(const std::string& name, const std::string& asset,
                          const std::filesystem::path& folder);

/// In quotes, without control characters.
std::string in_quotes(std::string_view name);

}  // namespace opaline
