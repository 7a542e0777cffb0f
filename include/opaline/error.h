// SPDX-License-Identifier: GPL-3.0-or-later
// The one exception type of the project: bad input, a failed run, or an interruption.
#pragma once

#include <exception>
#include <string>

namespace opaline {

/// Kind of an error, and exit code of the program: bad_input 2, run_failed 3 (I/O, memory), interrupted 130.
enum class ErrorKind { bad_input = 2, run_failed = 3, interrupted = 130 };

/// Thrown by parsing and I/O; caught in `main`, or where a position is added or the run continues. `what()`
/// is one line: "file:line:column: what (expected ..., got ...)", omitting empty or zero parts.
class Error : public std::exception {
 public:
  ErrorKind kind = ErrorKind::bad_input;
  std::string file;
  int line = 0;    // 1-based; 0: unknown
  int column = 0;  // 1-based, in bytes; 0: unknown
  std::string message;
  std::string expected;
  std::string got;

  Error(ErrorKind kind, std::string file, int line, int column, std::string message,
        std::string expected = {}, std::string got = {});

  const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

/// Bad input in a file as a whole.
Error bad_file(std::string file, std::string message, std::string expected = {}, std::string got = {});
/// Failure of the run itself: I/O, memory.
Error run_failed(std::string file, std::string message);

/// Aborts with the message if an invariant of the program is broken, also in release builds.
void require(bool invariant, const char* message);

}  // namespace opaline
