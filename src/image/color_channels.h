// SPDX-License-Identifier: GPL-3.0-or-later
// Which channels of a picture are colours, and in which space. Of the picture module, too (picture_reader.h).
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/rgb_primaries.h"

namespace opaline {

/// Red, green and blue of a layer, by their places among the channels.
struct ColorChannels {
  std::array<std::size_t, 3> places;
  bool is_variance = false;  ///< whose roots are converted
};

/// R, G, B and the same of every layer that has them. N, P and Cryptomatte's are none.
std::vector<ColorChannels> color_channels(const std::vector<std::string>& channels);

/// Indices of red, green, blue and alpha among an image's channels, -1 where it has none. The first three of a grey image
/// are alike.
using ChannelPlaces = std::array<int, 4>;

/// The channels that textures and environments take: R, G, B or Y, and A, in upper or lower case or in full ("red"),
/// plain or of the only layer that has them ("diffuse.R"); a single channel is grey whatever its name.
/// in    path: for messages
/// error Error{bad_input} naming the file: no such channels, several layers, luminance and chroma (RY, BY)
ChannelPlaces channel_places(const std::vector<std::string>& channels, const std::string& path);

/// True for channels of Cryptomatte: names and coverages, not colours.
bool is_matte_channel(std::string_view channel);
/// True if a layer is what one light adds: "diffuse_NAME", "specular_NAME", "emission_NAME".
bool is_light_group(std::string_view layer);

/// Converts pixels of `step` values each. Standard errors and variances become bounds, which hold however the channels'
/// errors go together.
void convert_colors(std::span<float> pixels, std::size_t step, std::span<const ColorChannels> colors,
                    const ColorMatrix& matrix);

const ColorMatrix& to_acescg();
const ColorMatrix& from_acescg();

}  // namespace opaline
