// SPDX-License-Identifier: GPL-3.0-or-later
// Paths of edits, as in `--set`.
#pragma once

#include <string>

namespace opaline {

/// True if an edit is of the path, or of a value inside it.
inline bool is_within(const std::string& edit, const std::string& path) {
  return edit.starts_with(path) && (edit.at(path.size()) == '=' || edit.at(path.size()) == '.');
}

}  // namespace opaline
