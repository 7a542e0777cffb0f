// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of an image in a file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "opaline/image.h"

namespace opaline {

/// Names of several layers: each light's contribution, the layers for selecting objects and materials, and the
/// radiance at each wavelength.
inline constexpr std::string_view kLightGroups = "light_groups", kCryptomatte = "cryptomatte",
                                  kWavelengths = "wavelengths";

/// Selected layers. The channels of the image itself, R G B A, are in every file; a layer is Z or the
/// channels "name.*".
struct LayerChoice {
  bool all = true;                 ///< all of the image's
  std::vector<std::string> names;  ///< unless all
};

/// True if a file with these layers has the channel.
bool has_channel(const LayerChoice& layers, const std::string& channel);

/// True if a layer is selected by its own name or one for several.
bool is_named(const LayerChoice& layers, std::string_view name);

/// write_exr with these layers only, and colours in the given space. Ignores layers missing in the image.
WriteReport write_exr(const std::string& path, const Image& image, bool half, const LayerChoice& layers,
                      FilmColorSpace space = FilmColorSpace::lin_rec709);

}  // namespace opaline
