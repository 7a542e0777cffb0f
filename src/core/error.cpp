// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/error.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace opaline {

Error::Error(ErrorKind kind_, std::string file_, int line_, int column_, std::string message_,
             std::string expected_, std::string got_)
    : kind(kind_),
      file(std::move(file_)),
      line(line_),
      column(column_),
      message(std::move(message_)),
      expected(std::move(expected_)),
      got(std::move(got_)) {
  if (!file.empty()) {
    text_ += file;
    if (line > 0) text_ += ':' + std::to_string(line);
    if (line > 0 && column > 0) text_ += ':' + std::to_string(column);
    text_ += ": ";
  }
  text_ += message;
  if (!expected.empty() || !got.empty()) {
    text_ += " (";
    if (!expected.empty()) text_ += "expected " + expected;
    if (!expected.empty() && !got.empty()) text_ += ", ";
    if (!got.empty()) text_ += "got " + got;
    text_ += ")";
  }
}

Error bad_file(std::string file, std::string message, std::string expected, std::string got) {
  return Error(ErrorKind::bad_input, std::move(file), 0, 0, std::move(message), std::move(expected),
               std::move(got));
}

Error run_failed(std::string file, std::string message) {
  return Error(ErrorKind::run_failed, std::move(file), 0, 0, std::move(message));
}

void require(bool invariant, const char* message) {
  if (invariant) return;
  std::fprintf(stderr, "opaline: broken invariant: %s\n", message);
  std::abort();
}

}  // namespace opaline
