// SPDX-License-Identifier: GPL-3.0-or-later
// Minimal edits of a scene's text, keeping layout and comments.
#pragma once

#include <string>
#include <string_view>

#include "values/json_tree.h"

namespace opaline {

/// The text with the differences of two trees. Values are replaced in place; new members of an object are
/// appended. Objects with removed members and lists of another length are rewritten, without their comments.
/// in    before: tree of the text; now: tree of the result
std::string edited_text(std::string_view text, const Node& before, const Node& now);

}  // namespace opaline
