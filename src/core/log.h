// SPDX-License-Identifier: GPL-3.0-or-later
// Log of the program. Text: results on stdout, warnings and errors on stderr. JSON: one object per line on
// stdout, {"event": "view" | "frame" | "skipped" | "target" | "plan" | "reuse" | "warning" | "progress" |
// "stage" | "done" | "error", ...}.
#pragma once

#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace opaline {

enum class LogFormat { text, json };

/// Progress of a range of frames.
struct FramesSoFar {
  std::size_t count = 0, finished = 0;  ///< all; rendered, existing or failed
  std::size_t rendered = 0;
  double seconds = 0;  ///< time of their rendering

  double fraction() const { return double(finished) / double(count); }
};

struct Log {
  LogFormat format = LogFormat::text;
  bool quiet = false;                   ///< warnings and errors only
  const FramesSoFar* frames = nullptr;  ///< set while a range is rendered
};

using Json = nlohmann::ordered_json;

/// One line without spaces; bytes other than UTF-8, possible in paths, become U+FFFD.
std::string compact(const Json& value);

/// Writes one line and flushes. Failures remain in ferror(stream), except for a closed pipe: a log must not
/// fail a render.
void write_line(std::FILE* stream, std::string_view line);

/// A JSON event; no effect on a text log.
void print_event(const Log& log, const char* event, const Json& members);

void print_warning(const Log& log, const std::string& text);

/// Prints the reason for ending the run and returns its exit code: Error by its kind, anything else 3.
int print_failure(const Log& log, const std::exception& failure);

}  // namespace opaline
