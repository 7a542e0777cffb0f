// SPDX-License-Identifier: GPL-3.0-or-later
// Which layers of a picture a file holds.
#pragma once

#include <string>
#include <vector>

#include "opaline/image/image.h"

namespace opaline {

/// The channels of one letter that are the picture itself, R G B A, are in every file; a layer is either Z or
/// the channels "name.*".
struct LayerChoice {
  bool all = true;
  std::vector<std::string> names;  ///< unless all
};

/// Whether a file with these layers has the channel.
bool has_channel(const LayerChoice& layers, const std::string& channel);

/// As write_exr, with these layers alone. Layers that the picture lacks are left out.
WriteReport write_exr(const std::string& path, const Image& image, bool half, const LayerChoice& layers);

}  // namespace opaline
