// SPDX-License-Identifier: GPL-3.0-or-later
// Adds layers to an image.
#pragma once

#include <span>
#include <string>

#include "opaline/image.h"

namespace opaline {

/// Appends channels of zeros. Pixels of zeros take no more memory than before.
void add_channels(Image& image, std::span<const std::string> names);

/// Place of a channel among the picture's; it must be there.
std::size_t channel_place(const Image& image, std::string_view name);

}  // namespace opaline
