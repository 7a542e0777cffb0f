// SPDX-License-Identifier: GPL-3.0-or-later
// Colour channels of an image and their colour space. Also part of the reader module (picture_reader.h).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/rgb_primaries.h"
#include "opaline/error.h"

namespace opaline {

/// Indices of red, green and blue of a layer among the channels.
struct ColorChannels {
  std::array<std::size_t, 3> places;
  bool is_variance = false;  ///< the roots of its values are converted
};

/// R, G, B of the image and of every layer having them; excludes N, P and Cryptomatte.
std::vector<ColorChannels> color_channels(const std::vector<std::string>& channels);

/// Indices of red, green, blue and alpha among an image's channels, -1 if missing. The first three are equal
/// for a grey image.
using ChannelPlaces = std::array<int, 4>;

/// Channels for textures and environments: R, G, B or Y, and A, in upper or lower case or in full ("red"),
/// plain or of the only layer having them ("diffuse.R"); a single channel is grey for any name, and
/// Y beside X is no luminance.
/// in    path: for messages
/// error Error{bad_input} naming the file: no such channels, several layers, luminance and chroma (RY, BY)
ChannelPlaces channel_places(const std::vector<std::string>& channels, const std::string& path);

/// True for the names of R, G, B and Y, of any layer.
bool is_color_channel(std::string_view channel);

/// Complaint of a channel of 32-bit integers used as a colour.
Error integer_colors(const std::string& path, const std::string& channel);

/// True for channels of Cryptomatte: names and coverages, not colours.
bool is_matte_channel(std::string_view channel);
/// True for a layer of one light's contribution: "diffuse_NAME", "specular_NAME", "emission_NAME".
bool is_light_group(std::string_view layer);

/// Converts pixels of `step` values each. Standard errors and variances become upper bounds, for any
/// correlation of the channels.
void convert_colors(std::span<float> pixels, std::size_t step, std::span<const ColorChannels> colors,
                    const ColorMatrix& matrix);

/// Matrix from a file's primaries to Rec.709; empty: those of Rec.709.
/// error Error{bad_input} naming the file: the primaries do not span a colour space
std::optional<ColorMatrix> matrix_to_rec709(const RgbPrimaries& primaries, const std::string& path);
const ColorMatrix& to_acescg();
const ColorMatrix& from_acescg();

}  // namespace opaline
