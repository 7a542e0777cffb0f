// SPDX-License-Identifier: GPL-3.0-or-later
// Command-line values, applied to the tree before validation.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "values/json_tree.h"

namespace opaline {

/// Applies document.overrides in order to document.root, an object. Creates missing keys; "+" appends to a list; a value
/// other than JSON is a string; a key replaces its old spelling.
/// error Error{bad_input} naming the override: no '=', a path through a single value, no such list element, a
///       probably misspelt medium
void apply_overrides(Document& document);

/// An environment map replacing all lights, with its values unchanged.
std::vector<std::string> environment_overrides(const std::string& picture);

/// Keys of a shape replaced by its "medium" or "reflectance"; none for other keys.
std::span<const std::string_view> replaced_surface_keys(std::string_view key);

}  // namespace opaline
