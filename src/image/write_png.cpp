// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenImageIO/color.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/atomic_file.h"
#include "core/parallel.h"
#include "image/png_chunks.h"
#include "image/view_transform.h"
#include "opaline/error.h"
#include "opaline/image.h"

namespace opaline {
namespace {

std::array<std::size_t, 3> rgb_channels(const Image& image) {
  std::array<std::size_t, 3> found{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto at = std::find(image.channels.begin(), image.channels.end(), std::string(1, "RGB"[c]));
    require(at != image.channels.end(), "a picture has the channels R, G and B");
    found[c] = static_cast<std::size_t>(at - image.channels.begin());
  }
  return found;
}

/// NaN and infinities become 0, as in the EXR.
float exposed(float value, double gain) {
  constexpr double kMost = std::numeric_limits<float>::max();
  if (!(std::isfinite(value) && value > 0)) return 0;
  return static_cast<float>(std::min(value * gain, kMost));
}

/// OpenImageIO's scalar formula is exact; its ColorConfig gives the same, except with another configuration
/// in $OCIO.
std::uint8_t quantize(float shown) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::min(OIIO::linear_to_sRGB(shown), 1.0f)));
}

std::string encoded(const std::string& path, int width, int height, const std::vector<std::uint8_t>& rgb) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(width);
  png.height = static_cast<png_uint_32>(height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
    throw run_failed(path, std::string("cannot write: ") + png.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace

void write_png(const std::string& path, const Image& image, double exposure, ViewTransform view) {
  const std::size_t channels = image.channels.size();
  const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  require(image.width > 0 && image.height > 0, "a picture has pixels");
  require(image.pixels.size() == pixels * channels, "a value per pixel and channel");
  const std::array<std::size_t, 3> rgb = rgb_channels(image);
  const double gain = std::exp2(exposure);
  AtomicFile file(path);
  std::vector<std::uint8_t> bytes(pixels * 3);
  parallel_chunks(pixels, 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const float* const pixel = image.pixels.data() + i * channels;
      const RgbF shown = shown_color(
          view, {exposed(pixel[rgb[0]], gain), exposed(pixel[rgb[1]], gain), exposed(pixel[rgb[2]], gain)});
      for (std::size_t c = 0; c < 3; ++c) bytes[3 * i + c] = quantize(shown[c]);
    }
  });
  file.append(with_png_texts(encoded(path, image.width, image.height, bytes), image.metadata));
  file.commit();
}

}  // namespace opaline
