// SPDX-License-Identifier: GPL-3.0-or-later
// Binary format of an image for a page.
#pragma once

#include <cstdint>
#include <string>

#include "view/view_renderer.h"

namespace opaline {

inline constexpr std::uint32_t kFrameMark = 0x314c504f;  ///< first word of a frame: "OPL1"

/// Little endian: eight 32-bit words (kFrameMark, number, revision, step, width, height, channels of the
/// layer, time of the image in microseconds), then R G B A of each pixel as halves, then the layer of each
/// pixel as floats.
/// layer: name as in `opaline render --layers`; omitted if the image lacks it
std::string pack_frame(const ViewPicture& picture, std::uint32_t number, const std::string& layer);

}  // namespace opaline
