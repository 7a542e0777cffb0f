// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/source_place.h"

namespace opaline {

std::string text_at(const SourcePlace& place, const std::string& text) {
  if (place.file.empty()) return text;
  std::string where = place.file;
  if (place.line > 0) where += ':' + std::to_string(place.line);
  if (place.line > 0 && place.column > 0) where += ':' + std::to_string(place.column);
  return where + ": " + text;
}

Error told_at(const SourcePlace& place, const Error& failure) {
  if (place.file.empty()) return failure;
  return Error(failure.kind, place.file, place.line, place.column,
               text_at({failure.file, failure.line, failure.column}, failure.message), failure.expected,
               failure.got);
}

}  // namespace opaline
