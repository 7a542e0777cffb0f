// SPDX-License-Identifier: GPL-3.0-or-later
// A scene's text with some of its values changed: all else stays as a person wrote it, comments too.
#pragma once

#include <string>
#include <string_view>

#include "values/json_tree.h"

namespace opaline {

/// The text, changed where two trees differ. Values are replaced where they stand; new members of an object come after
/// its others. An object that lost members, and a list of another length, is written anew, without the comments in it.
/// in    before: of the text; now: what the new text is to be read as
std::string edited_text(std::string_view text, const Node& before, const Node& now);

}  // namespace opaline
