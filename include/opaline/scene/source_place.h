// SPDX-License-Identifier: GPL-3.0-or-later
// Where a record of a scene was written, for failures that show only after the scene was read.
#pragma once

#include <string>

#include "opaline/core/error.h"

namespace opaline {

struct SourcePlace {
  std::string file;          ///< the scene file, or "--set path=value"; empty: made by a program
  int line = 0, column = 0;  ///< as in Error
  /// Where a thing is written is no part of what it is: scenes that differ in blanks alone are equal.
  friend bool operator==(const SourcePlace&, const SourcePlace&) { return true; }
};

/// "scene.json:3:12: text"; the text alone where the place is empty.
std::string text_at(const SourcePlace& place, const std::string& text);

/// The failure, said at the place of the record that it came from; a file it names, such as a mesh, goes into
/// the message. The same failure where the place is empty.
Error told_at(const SourcePlace& place, const Error& failure);

}  // namespace opaline
