// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_frame.h"

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/parallel.h"

namespace opaline {
namespace {

static_assert(std::endian::native == std::endian::little, "frames are sent as they lie in memory");

constexpr std::size_t kShown = 4;  // R G B A
constexpr float kLargestHalf = 65504;

/// Rounded as in a half-precision EXR.
half stored(float value) {
  return std::isfinite(value) ? half(std::clamp(value, -kLargestHalf, kLargestHalf)) : half(0.0f);
}

std::vector<std::size_t> channels_of(const Image& image, const std::string& layer) {
  std::vector<std::size_t> channels;
  for (std::size_t c = 0; c < image.channels.size() && !layer.empty(); ++c)
    if (image.channels[c] == layer || image.channels[c].starts_with(layer + '.')) channels.push_back(c);
  return channels;
}

}  // namespace

std::string pack_frame(const ViewPicture& picture, std::uint32_t number, const std::string& layer) {
  const Image& image = picture.image;
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height),
                    all = image.channels.size();
  const std::vector<std::size_t> channels = channels_of(image, layer);
  const std::array<std::uint32_t, 8> header{kFrameMark,
                                            number,
                                            picture.revision,
                                            std::uint32_t(picture.step),
                                            std::uint32_t(image.width),
                                            std::uint32_t(image.height),
                                            std::uint32_t(channels.size()),
                                            std::uint32_t(std::min(picture.seconds * 1e6, 4e9))};
  std::string bytes(sizeof header + pixels * (kShown * sizeof(half) + channels.size() * sizeof(float)), '\0');
  std::memcpy(bytes.data(), header.data(), sizeof header);
  char* const colours = bytes.data() + sizeof header;
  char* const values = colours + pixels * kShown * sizeof(half);
  parallel_chunks(pixels, 1 << 14, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t p = begin; p < end; ++p) {
      const float* pixel = image.pixels.data() + p * all;
      for (std::size_t c = 0; c < kShown; ++c) {
        const std::uint16_t bits = stored(pixel[c]).bits();
        std::memcpy(colours + (p * kShown + c) * sizeof bits, &bits, sizeof bits);
      }
      for (std::size_t c = 0; c < channels.size(); ++c)
        std::memcpy(values + (p * channels.size() + c) * sizeof(float), pixel + channels[c], sizeof(float));
    }
  });
  return bytes;
}

}  // namespace opaline
