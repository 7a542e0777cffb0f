// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of an image in a file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "opaline/image.h"

namespace opaline {

/// Words for several layers: of each light what it adds, and what it takes to select objects and materials.
inline constexpr std::string_view kLightGroups = "light_groups", kCryptomatte = "cryptomatte";

/// The channels of one letter that are the picture itself, R G B A, are in every file; a layer is either Z or
/// the channels "name.*".
struct LayerChoice {
  bool all = true;                 ///< that the picture has
  std::vector<std::string> names;  ///< unless all
};

/// True if a file with these layers has the channel.
bool has_channel(const LayerChoice& layers, const std::string& channel);

/// True if a layer is asked for by its name or word.
bool is_named(const LayerChoice& layers, std::string_view name);

/// As write_exr, with these layers alone, colours in the space. Layers that the picture lacks are left out.
WriteReport write_exr(const std::string& path, const Image& image, bool half, const LayerChoice& layers,
                      FilmColorSpace space = FilmColorSpace::lin_rec709);

}  // namespace opaline
