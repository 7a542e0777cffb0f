// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/color_channels.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "core/lower_case.h"
#include "opaline/error.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 4> kColorWords{"red", "green", "blue", "alpha"};

/// Part of a channel's name after its layer, in lower case.
std::string component_of(std::string_view channel) {
  return in_lower_case(channel.substr(channel.rfind('.') + 1));
}

/// Includes the dot; empty: none.
std::string_view layer_of(std::string_view channel) {
  return channel.substr(0, channel.rfind('.') + 1);
}

bool is_color_word(const std::string& component, std::size_t k) {
  return component == kColorWords[k] || component == kColorWords[k].substr(0, 1);
}

bool has_color(const ChannelPlaces& places) {
  return std::max({places[0], places[1], places[2]}) >= 0;
}

/// Channel indices of one layer.
ChannelPlaces places_in(std::string_view layer, const std::vector<std::string>& channels) {
  ChannelPlaces places{-1, -1, -1, -1};
  int grey = -1;
  bool is_vector = false;
  for (int c = 0; c < int(channels.size()); ++c) {
    if (layer_of(channels[std::size_t(c)]) != layer) continue;
    const std::string component = component_of(channels[std::size_t(c)]);
    for (std::size_t k = 0; k < places.size(); ++k)
      if (is_color_word(component, k)) places[k] = c;
    if (component == "y") grey = c;
    is_vector = is_vector || component == "x";
  }
  if (grey >= 0 && !is_vector && !has_color(places)) places = {grey, grey, grey, places[3]};
  return places;
}

std::string listed(const std::vector<std::string>& channels) {
  constexpr std::size_t kMost = 12;
  std::string text;
  for (std::size_t c = 0; c < std::min(channels.size(), kMost); ++c)
    text += (c > 0 ? ", " : "") + channels[c];
  return text + (channels.size() > kMost ? ", ..." : "");
}

bool are_same(const RgbPrimaries& a, const RgbPrimaries& b) {
  constexpr double kRounding = 1e-4;  // rounding of primaries given with four digits
  for (const auto& [x, y] : {std::pair(a.red, b.red), std::pair(a.green, b.green), std::pair(a.blue, b.blue),
                             std::pair(a.white, b.white)})
    if (!(std::abs(x[0] - y[0]) < kRounding && std::abs(x[1] - y[1]) < kRounding)) return false;
  return true;
}

std::string text_of(const RgbPrimaries& p) {
  std::ostringstream text;
  const char* before = "";
  for (const auto& [name, xy] : {std::pair("red", p.red), std::pair("green", p.green),
                                 std::pair("blue", p.blue), std::pair("white", p.white)}) {
    text << before << name << ' ' << xy[0] << ' ' << xy[1];
    before = ", ";
  }
  return text.str();
}

bool is_finite_matrix(const ColorMatrix& matrix) {
  constexpr double kMost = 1e3;  // maximum weights, exceeded by nearly collinear primaries
  return std::ranges::all_of(
      matrix, [](const Vec3d& row) { return max_component(component_max(row, -row)) < kMost; });
}

}  // namespace

ChannelPlaces channel_places(const std::vector<std::string>& channels, const std::string& path) {
  constexpr const char* expected = "the channels R, G and B, or Y, or one alone";
  if (channels.size() == 1) return {0, 0, 0, is_color_word(component_of(channels[0]), 3) ? 0 : -1};
  if (std::ranges::any_of(channels, [](const std::string& c) { return component_of(c) == "ry"; }))
    throw bad_file(path, "stores colours as luminance and chroma", expected, listed(channels));
  ChannelPlaces places = places_in("", channels);
  if (has_color(places)) return places;
  std::set<std::string_view> layers;
  for (const std::string& channel : channels) {
    const ChannelPlaces of_layer = places_in(layer_of(channel), channels);
    if (!has_color(of_layer) || is_matte_channel(channel)) continue;
    layers.insert(layer_of(channel));
    places = of_layer;
  }
  if (layers.size() == 1) return places;
  throw bad_file(path, layers.empty() ? "has no colours" : "has several colour layers, none of them unnamed",
                 expected, listed(channels));
}

bool is_color_channel(std::string_view channel) {
  const std::string component = component_of(channel);
  return component == "y" || is_color_word(component, 0) || is_color_word(component, 1) ||
         is_color_word(component, 2);
}

Error integer_colors(const std::string& path, const std::string& channel) {
  return bad_file(path, "the channel " + channel + " stores integers (UINT), which are not colours",
                  "channels of type HALF or FLOAT");
}

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

std::optional<ColorMatrix> matrix_to_rec709(const RgbPrimaries& primaries, const std::string& path) {
  if (are_same(primaries, kRec709Primaries)) return {};
  if (are_same(primaries, kAp1Primaries)) return from_acescg();
  const ColorMatrix matrix = color_matrix(primaries, kRec709Primaries);
  if (!is_finite_matrix(matrix))
    throw bad_file(path, "has chromaticities that span no colour space",
                   "red, green and blue not on one line, and white between them", text_of(primaries));
  return matrix;
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
