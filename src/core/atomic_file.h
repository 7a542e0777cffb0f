// SPDX-License-Identifier: GPL-3.0-or-later
// Output files, written completely or not at all.
#pragma once

#include <string>
#include <string_view>

namespace opaline {

/// Output under a temporary name beside the final file; `commit` renames it. Otherwise the destructor removes
/// it: an interrupted or failed run leaves the old file or none.
class AtomicFile {
 public:
  /// error Error{run_failed} if the folder cannot be written
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Path for writing; has the final file's extension, for writers choosing the format by it.
  const std::string& temporary() const { return temporary_; }

  /// Adds bytes at the end of the temporary file.
  /// error Error{run_failed} naming the file: disk full, I/O error
  void append(std::string_view bytes);

  /// Flushes to the disk and renames.
  /// error Error{run_failed} naming the file: disk full, I/O error
  void commit();

  /// Renames without waiting for the disk: a power failure may leave a torn file. For files with checksums.
  /// error as commit
  void commit_unflushed();

 private:
  void put_in_place(int failure);

  std::string path_, temporary_;
  bool committed_ = false;
};

/// Writes bytes to path through an AtomicFile.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace opaline
