// SPDX-License-Identifier: GPL-3.0-or-later
// The program's voice. Text: results on stdout, warnings and errors on stderr. JSON: one object a line on
// stdout,
// {"event": "view" | "frame" | "skipped" | "target" | "plan" | "reuse" | "warning" | "progress" | "stage" | "done" |
// "error", ...}.
#pragma once

#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace opaline {

enum class LogFormat { text, json };

/// How far a range of frames is.
struct FramesSoFar {
  std::size_t count = 0, finished = 0;  ///< all; rendered, there already or failed
  std::size_t rendered = 0;
  double seconds = 0;  ///< that rendering them took

  double fraction() const { return double(finished) / double(count); }
};

struct Log {
  LogFormat format = LogFormat::text;
  bool quiet = false;                   ///< warnings and errors only
  const FramesSoFar* frames = nullptr;  ///< set while a range is rendered
};

using Json = nlohmann::ordered_json;

/// One line without spaces; bytes that are not UTF-8 (a path may hold any) become U+FFFD.
std::string compact(const Json& value);

/// One line, flushed. Failures are left in ferror(stream), but for a pipe that nobody reads any more: a log must not cost
/// a picture.
void write_line(std::FILE* stream, std::string_view line);

/// A JSON event; only where the log is JSON.
void print_event(const Log& log, const char* event, const Json& members);

void print_warning(const Log& log, const std::string& text);

/// Prints what ended the run and returns its exit code: Error by its kind, anything else 3.
int print_failure(const Log& log, const std::exception& failure);

}  // namespace opaline
