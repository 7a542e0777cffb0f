// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenImageIO/color.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "encode.h"
#include "opaline/core/error.h"
#include "opaline/image/image.h"

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

/// NaN and infinities become 0, as in the EXR. OpenImageIO's scalar formula is the exact one; its ColorConfig
/// would give the same, unless $OCIO named another configuration.
std::uint8_t quantize(float value, double gain) {
  const double exposed = std::isfinite(value) && value > 0 ? value * gain : 0.0;
  const float encoded = OIIO::linear_to_sRGB(static_cast<float>(std::min(exposed, 1.0)));
  return static_cast<std::uint8_t>(std::lround(255.0f * std::min(encoded, 1.0f)));
}

}  // namespace

void write_png(const std::string& path, const Image& image, double exposure) {
  const std::size_t channels = image.channels.size();
  const auto width = static_cast<std::size_t>(image.width);
  require(image.width > 0 && image.height > 0, "a picture has pixels");
  require(image.pixels.size() == width * static_cast<std::size_t>(image.height) * channels,
          "a value per pixel and channel");
  const std::array<std::size_t, 3> rgb = rgb_channels(image);
  const double gain = std::exp2(exposure);

  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  std::vector<std::uint8_t> strip;
  encode(path, "png", spec, OIIO::TypeUInt8, [&](int first, int count) {
    const float* values = image.pixels.data() + static_cast<std::size_t>(first) * width * channels;
    strip.resize(static_cast<std::size_t>(count) * width * 3);
    for (std::size_t i = 0; i < strip.size(); ++i)
      strip[i] = quantize(values[i / 3 * channels + rgb[i % 3]], gain);
    return strip.data();
  });
}

}  // namespace opaline
