// SPDX-License-Identifier: GPL-3.0-or-later
// Deprecated spellings of a scene's keys and values.
#pragma once

#include <string>

#include "values/json_tree.h"

namespace opaline {

/// Replaces old spellings in the tree by current ones, with a line in document.warnings for each. A later
/// override replaces the value of the same key in either spelling.
/// error Error{bad_input}: both spellings of a key in the file, or in one override
void replace_deprecated_spellings(Document& document);
/// The same for one medium; path: prefix of its keys in warnings.
void replace_deprecated_spellings(Document& document, Node& medium, const std::string& path);

}  // namespace opaline
