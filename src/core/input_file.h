// SPDX-License-Identifier: GPL-3.0-or-later
// Input files. Only regular files are read: a pipe or device may block or never end.
#pragma once

#include <cstdint>
#include <string>

namespace opaline {

/// A regular file, open for reading. All input files are opened here, or checked here where a library opens
/// them.
class InputFile {
 public:
  /// in    noun: name of the file in messages; hint: appended to the message for a missing file
  /// error Error{bad_input} naming the file: missing, not a regular file, not permitted
  explicit InputFile(const std::string& path, const std::string& noun = "file",
                     std::string (*hint)(const std::string& path) = nullptr);

  /// Bytes, at the time of opening.
  std::uintmax_t size() const { return size_; }
  /// Bytes from `begin` on, at most `most`; fewer at the file's end.
  /// error Error{run_failed} naming the file: reading failed
  std::string read(std::uintmax_t begin, std::uintmax_t most) const;
  /// error as read, also for a file that became shorter
  std::string read_all() const;

 private:
  struct Descriptor {
    int number = -1;
    Descriptor() = default;
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor();
  };

  std::string path_;
  Descriptor descriptor_;
  std::uintmax_t size_ = 0;
};

}  // namespace opaline
