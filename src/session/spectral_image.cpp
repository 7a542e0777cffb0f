// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/spectral_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/parallel.h"
#include "image/add_channels.h"
#include "opaline/error.h"
#include "spectra/wavelengths.h"

namespace opaline {
namespace {

enum class Weight { plain, square, magnitude };

/// Three adjacent channels.
struct ColorLayer {
  std::size_t red;
  Weight weight;
};

std::vector<ColorLayer> color_layers(const Image& image) {
  std::vector<ColorLayer> layers;
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    const std::string_view name = image.channels[c];
    const auto is = [&](std::string_view layer) { return name == std::string(layer) + ".R"; };
    if (name == "R" || is("diffuse") || is("specular") || is("albedo") || is("irradiance"))
      layers.push_back({c, Weight::plain});
    if (is("variance")) layers.push_back({c, Weight::square});
    if (is("error")) layers.push_back({c, Weight::magnitude});
  }
  return layers;
}

template <class Use>
void for_each_pixel(const Image& image, const Use& use) {
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  parallel_chunks(pixels, 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) use(i * image.channels.size());
  });
}

Rgb weighted(const Rgb& weight, Weight by) {
  if (by == Weight::plain) return weight;
  if (by == Weight::square) return weight * weight;
  return {std::abs(weight.x), std::abs(weight.y), std::abs(weight.z)};
}

}  // namespace

void convert_to_rgb(Image& image, const std::array<Rgb, 3>& to_rgb) {
  const std::vector<ColorLayer> layers = color_layers(image);
  for_each_pixel(image, [&](std::size_t pixel) {
    for (const ColorLayer& layer : layers) {
      float* const values = image.pixels.data() + pixel + layer.red;
      Rgb color;
      for (std::size_t c = 0; c < 3; ++c) color += weighted(to_rgb[c], layer.weight) * double(values[c]);
      for (std::size_t c = 0; c < 3; ++c) values[c] = float(color[c]);
    }
  });
}

void WavelengthLayers::keep(const Image& image, const ThreeWavelengths& wavelengths) {
  const std::size_t red = channel_place(image, "R");
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [low, high] = wavelengths.bands[c];
    std::string name = fmt::format("{:.6g}", .5 * (low + high));
    std::ranges::replace(name, '.', ',');
    names_.push_back("S0." + name + "nm");
    std::vector<float>& values = values_.emplace_back(image.pixels.size() / image.channels.size());
    const auto daylight = float(unit_d65().mean(low, high));
    for_each_pixel(image, [&](std::size_t pixel) {
      values[pixel / image.channels.size()] = image.pixels.data()[pixel + red + c] * daylight;
    });
  }
}

void WavelengthLayers::append(Image& image) const {
  if (names_.empty()) return;
  const std::size_t first = image.channels.size();
  add_channels(image, names_);
  for_each_pixel(image, [&](std::size_t pixel) {
    for (std::size_t w = 0; w < values_.size(); ++w)
      image.pixels.data()[pixel + first + w] = values_[w][pixel / image.channels.size()];
  });
}

void add_colors(Image& image, const Image& other) {
  require(image.channels == other.channels && image.pixels.size() == other.pixels.size(),
          "images of one view have the same layers");
  const std::vector<ColorLayer> layers = color_layers(image);
  for_each_pixel(image, [&](std::size_t pixel) {
    for (const ColorLayer& layer : layers)
      for (std::size_t c = layer.red; c < layer.red + 3; ++c)
        image.pixels[pixel + c] += other.pixels[pixel + c];
  });
}

}  // namespace opaline
