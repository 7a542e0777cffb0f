// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/error_picture.h"

#include <OpenImageIO/color.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline {
namespace {

Image make_image(const Layer& layer, const std::vector<std::string>& channels) {
  Image image;
  image.width = layer.width;
  image.height = layer.height;
  image.channels = channels;
  image.pixels.resize(static_cast<std::size_t>(layer.width) * static_cast<std::size_t>(layer.height) *
                      channels.size());
  return image;
}

/// Displayed colour of a pixel compared in every channel.
RgbF colour_of(double error) {
  const double decades = std::log10(brightest_error / darkest_error);
  return brightness_ordered_colour(error > 0 ? std::log10(error / darkest_error) / decades : 0.0);
}

}  // namespace

RgbF brightness_ordered_colour(double place) {
  constexpr double start = .1, rotations = .5, hue = 1.6;  // blue at first, half a turn to orange
  const double x = std::clamp(place, 0.0, 1.0);
  const double angle = 2 * std::numbers::pi * (start / 3 + 1 + rotations * x);
  const double amplitude = hue * x * (1 - x) / 2, c = std::cos(angle), s = std::sin(angle);
  const Rgb colour =
      Rgb(x) + amplitude * Rgb{-.14861 * c + 1.78277 * s, -.29227 * c - .90649 * s, 1.97294 * c};
  return RgbF(component_min(component_max(colour, Rgb(0.0)), Rgb(1.0)));
}

Image error_colours(const RelativeErrors& errors, const Layer& layer,
                    const std::vector<std::uint8_t>& object) {
  const RgbF no_object(.22f), not_finite(0, 1, 0);
  Image image = make_image(layer, {"R", "G", "B"});
  for (std::size_t i = 0; i < object.size(); ++i) {
    double largest = 0;
    bool finite = true;
    for (const std::vector<double>& channel : errors.channels) {
      finite = finite && !std::isnan(channel[i]);
      largest = std::max(largest, std::abs(channel[i]));
    }
    const RgbF shown = !object[i] ? no_object : finite ? colour_of(largest) : not_finite;
    for (std::size_t c = 0; c < 3; ++c) image.pixels[3 * i + c] = OIIO::sRGB_to_linear(shown[c]);
  }
  return image;
}

Image signed_errors(const RelativeErrors& errors, const Layer& layer) {
  std::vector<std::string> names;
  for (const std::string& name : layer.names) names.push_back(name.substr(name.rfind('.') + 1));
  Image image = make_image(layer, names);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double error = errors.channels[i % names.size()][i / names.size()];
    image.pixels[i] = std::isnan(error) ? 0.0f : static_cast<float>(error);
  }
  return image;
}

}  // namespace opaline
