// SPDX-License-Identifier: GPL-3.0-or-later
// Files that the program reads: regular files alone. A pipe or device may block for ever, or never end.
#pragma once

#include <cstdint>
#include <string>

namespace opaline {

/// A regular file, open for reading. All input files are opened here, or checked here where a library opens them.
class InputFile {
 public:
  /// in    noun: how messages call the file; hint: appended to the message where there is no such file
  /// error Error{bad_input} naming the file: missing, no regular file, not permitted
  explicit InputFile(const std::string& path, const std::string& noun = "file",
                     std::string (*hint)(const std::string& path) = nullptr);

  /// Bytes, when it was opened.
  std::uintmax_t size() const { return size_; }
  /// The bytes from `begin` on, at most `most`; fewer where the file ends.
  /// error Error{run_failed} naming the file: reading failed
  std::string read(std::uintmax_t begin, std::uintmax_t most) const;
  /// error as read, also where the file became shorter
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
