// SPDX-License-Identifier: GPL-3.0-or-later
// Small picture files for textures.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "opaline/image.h"

namespace opaline::test {

/// IEC 61966-2-1.
inline double linear_of_byte(double byte) {
  const double v = byte / 255;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

template <class Color>
Image picture_of_texels(int width, int height, const Color& color) {
  Image image;
  image.width = image.full_width = width;
  image.height = image.full_height = height;
  image.channels = {"R", "G", "B"};
  image.pixels.resize(std::size_t(width) * std::size_t(height) * 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        image.pixels[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 3 + c] = float(color(x, y)[c]);
  return image;
}

using Bytes = std::array<int, 3>;

/// A PNG of 8 bits that holds the bytes of bytes(x, y); y downwards.
template <class BytesAt>
void put_png(const std::string& path, int width, int height, const BytesAt& bytes) {
  write_png(
      path,
      picture_of_texels(
          width, height,
          [&](int x, int y) {
            const Bytes b = bytes(x, y);
            return std::array<double, 3>{linear_of_byte(b[0]), linear_of_byte(b[1]), linear_of_byte(b[2])};
          }),
      0);
}
inline void put_png(const std::string& path, int width, int height, const Bytes& bytes) {
  put_png(path, width, height, [&](int, int) { return bytes; });
}

/// An EXR of floats.
template <class Color>
void put_exr(const std::string& path, int width, int height, const Color& color) {
  write_exr(path, picture_of_texels(width, height, color), false);
}

}  // namespace opaline::test
