// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/picture_size.h"

#include <algorithm>

#include "opaline/error.h"

namespace opaline {
namespace {

std::string by(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

// Constant images, with a margin.
double densest_exr(bool is_dwa) {
  return is_dwa ? 32768 : 2048;
}

// Memory of the libraries besides the image: rows of OpenImageIO (256, even for fewer) and of OpenEXR (32 per
// thread).
void check_picture_size(const std::string& path, const PictureSize& size, std::uintmax_t bytes) {
  if (size.width < 1 || size.height < 1)  // Radiance files may have any sign
    throw bad_file(path, "has no pixels", "a width and height of at least 1", by(size.width, size.height));
  constexpr double always_allowed = 512 << 20, rows_beside = 1024;
  const double claimed =
      sizeof(float) * double(size.width) * (double(size.height) + rows_beside) * size.channels;
  if (claimed > size.densest * double(bytes) + always_allowed)
    throw bad_file(path, "the file is too short for the size it claims", {},
                   by(size.width, size.height) + " pixels");
  // Small files may have any size: constant images are highly compressible, but decoding takes time and
  // memory.
  constexpr double most_pixels = 1 << 29;
  const std::int64_t width = std::max(size.width, size.full_width),
                     height = std::max(size.height, size.full_height);
  if (double(width) * double(height) > most_pixels)
    throw bad_file(path, "the image is too large", "at most 537 million pixels, such as 32,768 x 16,384",
                   by(width, height) + ", " +
                       std::to_string(std::int64_t(1e-6 * double(width) * double(height))) +
                       " million; make it smaller");
}

}  // namespace opaline
