// SPDX-License-Identifier: GPL-3.0-or-later
// Size that an image file claims. Also part of the reader module (picture_reader.h).
#pragma once

#include <cstdint>
#include <string>

namespace opaline {

/// Size by an image file's header; a damaged header may claim any.
struct PictureSize {
  std::int64_t width, height;  ///< pixels of the data window, or of a tile if larger
  int channels;
  std::int64_t full_width, full_height;  ///< display window
  /// Largest ratio of floats in memory to bytes in the file, by the most compressible images of the format.
  double densest;
};

/// Ratio `densest` for EXRs.
double densest_exr(bool is_dwa);

/// in    bytes: length of the file
/// error Error{bad_input} naming the file: no pixels, too many, more than its bytes can hold
void check_picture_size(const std::string& path, const PictureSize& size, std::uintmax_t bytes);

}  // namespace opaline
