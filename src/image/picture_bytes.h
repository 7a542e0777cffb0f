// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes of an image before decoding. Also part of the reader module (picture_reader.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/input_file.h"

namespace opaline {

/// An encoded image: a file, or bytes in memory.
struct PictureSource {
  std::string path;   ///< for messages, and for reading without bytes
  std::string bytes;  ///< bytes of the file
  bool repeats = true;
};

/// Reads a source; must not outlive it.
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
