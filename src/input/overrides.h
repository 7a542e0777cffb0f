// SPDX-License-Identifier: GPL-3.0-or-later
// Command-line values, applied to the tree before validation.
#pragma once

#include <span>
#include <string_view>

#include "values/json_tree.h"

namespace opaline {

/// Applies document.overrides in order to document.root, an object. Creates missing keys; a value other than
/// JSON is a string; a key replaces its old spelling.
/// error Error{bad_input} naming the override: no '=', a path through a single value, no such list element, a
///       probably misspelt medium
void apply_overrides(Document& document);

/// Keys of a shape replaced by its "medium" or "reflectance"; none for other keys.
std::span<const std::string_view> replaced_surface_keys(std::string_view key);

}  // namespace opaline
