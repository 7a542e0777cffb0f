// SPDX-License-Identifier: GPL-3.0-or-later
// Values given on the command line, put into the tree before it is checked.
#pragma once

#include "values/json_tree.h"

namespace opaline {

/// Applies document.overrides in order to document.root, an object. Missing keys are created; a value that is
/// not JSON is taken as a string; a key replaces its old spelling.
/// error Error{bad_input} naming the override: no
/// '=', a path through a single value, no such list element, a new medium that only a slip explains
void apply_overrides(Document& document);

}  // namespace opaline
