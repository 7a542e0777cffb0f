// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenImageIO/half.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "encode.h"
#include "opaline/core/error.h"
#include "opaline/image/image.h"

namespace opaline {
namespace {

constexpr float half_max = 65504.0f;

/// Positions, depths, irradiance and variances need more than a half's 11 bits or its range.
bool always_float(const std::string& channel) {
  return channel == "Z" || channel.starts_with("P.") || channel.starts_with("irradiance.") ||
         channel.starts_with("variance.");
}

OIIO::ImageSpec make_spec(const Image& image, const std::vector<OIIO::TypeDesc>& formats) {
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()), OIIO::TypeFloat);
  spec.channelnames = image.channels;
  spec.channelformats = formats;
  spec.x = image.crop_x;
  spec.y = image.crop_y;
  spec.full_width = image.full_width > 0 ? image.full_width : image.width;
  spec.full_height = image.full_height > 0 ? image.full_height : image.height;
  for (const auto& [name, value] : image.metadata) spec.attribute(name, value);
  spec.attribute("compression",
                 "zip:1");  // 3 % larger than at the usual level 4, in three quarters of its time
  spec.attribute("Software", "opaline");
  // OpenImageIO stamps the time of writing unless there is one, and the bytes would move with it.
  spec.attribute("DateTime", "1970:01:01 00:00:00");
  return spec;
}

float storable(float value, bool half, WriteReport& report) {
  if (!std::isfinite(value)) {
    ++report.non_finite;
    return 0.0f;
  }
  if (half && std::abs(value) > half_max) {
    ++report.half_overflow;
    return std::copysign(half_max, value);
  }
  return value;
}

// Appends the value's bytes; the place after them.
char* store(float value, bool half, char* to) {
  if (!half) {
    std::memcpy(to, &value, sizeof value);
    return to + sizeof value;
  }
  const ::half rounded(value);
  std::memcpy(to, &rounded, sizeof rounded);
  return to + sizeof rounded;
}

}  // namespace

WriteReport write_exr(const std::string& path, const Image& image, bool half) {
  const std::size_t channels = image.channels.size();
  const std::size_t row = static_cast<std::size_t>(image.width) * channels;
  require(image.width > 0 && image.height > 0 && channels > 0, "a picture has pixels and channels");
  require(image.pixels.size() == row * static_cast<std::size_t>(image.height),
          "a value per pixel and channel");

  std::vector<OIIO::TypeDesc> formats;
  for (const std::string& channel : image.channels)
    formats.push_back(half && !always_float(channel) ? OIIO::TypeHalf : OIIO::TypeFloat);

  WriteReport report;
  std::vector<bool> is_half;
  std::size_t pixel_bytes = 0;
  for (const OIIO::TypeDesc& format : formats) {
    is_half.push_back(format == OIIO::TypeHalf);
    pixel_bytes += format.size();
  }
  std::vector<char> strip;
  // In the file's own layout: OpenImageIO's conversion from floats takes twice as long.
  encode(path, "exr", make_spec(image, formats), OIIO::TypeUnknown, [&](int first, int count) {
    const std::size_t pixels = static_cast<std::size_t>(count) * static_cast<std::size_t>(image.width);
    const float* value = image.pixels.data() + static_cast<std::size_t>(first) * row;
    strip.resize(pixels * pixel_bytes);
    char* to = strip.data();
    for (std::size_t i = 0; i < pixels; ++i)
      for (std::size_t c = 0; c < channels; ++c)
        to = store(storable(*value++, is_half[c], report), is_half[c], to);
    return strip.data();
  });
  return report;
}

}  // namespace opaline
