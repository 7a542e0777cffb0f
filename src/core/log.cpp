// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/log.h"

#include <cerrno>
#include <filesystem>

#include "core/out_of_memory.h"
#include "opaline/error.h"

namespace opaline {
namespace {

const char* name_of(ErrorKind kind) {
  return kind == ErrorKind::bad_input     ? "bad_input"
         : kind == ErrorKind::interrupted ? "interrupted"
                                          : "run_failed";
}

/// Reason for ending the run, also for exceptions of libraries.
std::string text_of(const std::exception& failure) {
  if (is_out_of_memory(failure)) return "out of memory";
  if (const auto* files = dynamic_cast<const std::filesystem::filesystem_error*>(&failure))
    return files->path1().string() + ": " + files->code().message();
  return failure.what();
}

}  // namespace

std::string compact(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void write_line(std::FILE* stream, std::string_view line) {
  const std::string whole = std::string(line) + '\n';
  errno = 0;
  const bool is_written =
      std::fwrite(whole.data(), 1, whole.size(), stream) == whole.size() && std::fflush(stream) == 0;
  if (!is_written && errno == EPIPE) std::clearerr(stream);  // the reader has closed the pipe
}

void print_event(const Log& log, const char* event, const Json& members) {
  if (log.format != LogFormat::json) return;
  Json line{{"event", event}};
  line.update(members);
  write_line(stdout, compact(line));
}

void print_warning(const Log& log, const std::string& text) {
  print_event(log, "warning", {{"message", text}});
  if (log.format == LogFormat::text) write_line(stderr, "opaline: warning: " + text);
}

int print_failure(const Log& log, const std::exception& failure) {
  const auto* error = dynamic_cast<const Error*>(&failure);
  const ErrorKind kind = error != nullptr ? error->kind : ErrorKind::run_failed;
  const std::string text = text_of(failure);
  Json members{{"kind", name_of(kind)}, {"exit_code", int(kind)}, {"message", text}};
  if (error != nullptr && !error->file.empty()) members["file"] = error->file;
  if (error != nullptr && error->line > 0) members["line"] = error->line;
  if (error != nullptr && error->column > 0) members["column"] = error->column;
  print_event(log, "error", members);
  if (log.format == LogFormat::text || std::ferror(stdout) != 0)
    write_line(stderr, kind == ErrorKind::interrupted ? "opaline: " + text : "opaline: error: " + text);
  return int(kind);
}

}  // namespace opaline
