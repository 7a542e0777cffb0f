// SPDX-License-Identifier: GPL-3.0-or-later
// Adds layers to an image.
#pragma once

#include <span>
#include <string>

#include "opaline/image.h"

namespace opaline {

/// Appends channels of zeros. Empty pixels need no additional memory.
void add_channels(Image& image, std::span<const std::string> names);

/// Index of an existing channel of the image.
std::size_t channel_place(const Image& image, std::string_view name);

}  // namespace opaline
