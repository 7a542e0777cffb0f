// SPDX-License-Identifier: GPL-3.0-or-later
// Position of a scene's record in its file, for errors detected after reading.
#pragma once

#include <string>

#include "opaline/core/error.h"

namespace opaline {

struct SourcePlace {
  std::string file;          ///< the scene file, or "--set path=value"; empty: generated
  int line = 0, column = 0;  ///< as in Error
  /// Always equal: scenes differing in layout alone are equal.
  friend bool operator==(const SourcePlace&, const SourcePlace&) { return true; }
};

/// "scene.json:3:12: text"; the text alone without a position.
std::string text_at(const SourcePlace& place, const std::string& text);

/// Error at the position of its record, with its own file, such as a mesh, in the message. Unchanged without
/// a position.
Error told_at(const SourcePlace& place, const Error& failure);

}  // namespace opaline
