// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/color_channels.h"

#include <algorithm>
#include <cmath>

namespace opaline {

bool is_matte_channel(std::string_view channel) {
  return channel.starts_with("Crypto");
}

bool is_light_group(std::string_view layer) {
  return layer.starts_with("diffuse_") || layer.starts_with("specular_") || layer.starts_with("emission_");
}

std::vector<ColorChannels> color_channels(const std::vector<std::string>& channels) {
  std::vector<ColorChannels> colors;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const std::string& red = channels[c];
    if ((red != "R" && !red.ends_with(".R")) || is_matte_channel(red)) continue;
    const std::string layer = red.substr(0, red.size() - 1);
    const auto green = std::ranges::find(channels, layer + 'G'),
               blue = std::ranges::find(channels, layer + 'B');
    if (green == channels.end() || blue == channels.end()) continue;
    colors.push_back({{c, std::size_t(green - channels.begin()), std::size_t(blue - channels.begin())},
                      layer == "variance."});
  }
  return colors;
}

void convert_colors(std::span<float> pixels, std::size_t step, std::span<const ColorChannels> colors,
                    const ColorMatrix& matrix) {
  for (std::size_t i = 0; i < pixels.size(); i += step)
    for (const auto& [places, is_variance] : colors) {
      Vec3d color;
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = double(pixels[i + places[c]]);
        color[c] = is_variance ? std::sqrt(std::max(value, 0.0)) : value;
      }
      color = matrix * color;
      for (std::size_t c = 0; c < 3; ++c)
        pixels[i + places[c]] = float(is_variance ? color[c] * color[c] : color[c]);
    }
}

const ColorMatrix& to_acescg() {
  static const ColorMatrix matrix = color_matrix(kRec709Primaries, kAp1Primaries);
  return matrix;
}

const ColorMatrix& from_acescg() {
  static const ColorMatrix matrix = color_matrix(kAp1Primaries, kRec709Primaries);
  return matrix;
}

}  // namespace opaline
