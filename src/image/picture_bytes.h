// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of a picture that is to be decoded. Of the picture module, too (picture_reader.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/input_file.h"

namespace opaline {

/// A picture's bytes: a file, or in memory.
struct PictureSource {
  std::string path;   ///< for messages, and to read unless there are bytes
  std::string bytes;  ///< bytes of the file
  bool repeats = true;
};

/// Reads a source, which outlives it.
class PictureBytes {
 public:
  /// error as InputFile
  explicit PictureBytes(const PictureSource& source);
  std::uintmax_t size() const { return file_ ? file_->size() : source_.bytes.size(); }
  /// As InputFile::read.
  std::string read(std::uintmax_t begin, std::uintmax_t most) const;

 private:
  const PictureSource& source_;
  std::optional<InputFile> file_;
};

}  // namespace opaline
