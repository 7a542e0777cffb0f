// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/add_channels.h"

#include <algorithm>

#include "core/parallel.h"
#include "opaline/error.h"

namespace opaline {

void add_channels(Image& image, std::span<const std::string> names) {
  const std::size_t before = image.channels.size(), after = before + names.size(),
                    pixels = std::size_t(image.width) * std::size_t(image.height);
  image.channels.insert(image.channels.end(), names.begin(), names.end());
  ZeroedArray<float> values(pixels * after);
  parallel_chunks(pixels, 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const float* const pixel = image.pixels.data() + i * before;
      if (std::any_of(pixel, pixel + before, [](float value) { return value != 0; }))
        std::copy_n(pixel, before, values.data() + i * after);
    }
  });
  image.pixels = std::move(values);
}

std::size_t channel_place(const Image& image, std::string_view name) {
  const auto at = std::ranges::find(image.channels, name);
  require(at != image.channels.end(), "a channel of the picture");
  return std::size_t(at - image.channels.begin());
}

}  // namespace opaline
