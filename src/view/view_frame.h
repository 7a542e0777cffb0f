// SPDX-License-Identifier: GPL-3.0-or-later
// A picture as the bytes that a page draws.
#pragma once

#include <cstdint>
#include <string>

#include "view/view_renderer.h"

namespace opaline {

inline constexpr std::uint32_t kFrameMark = 0x314c504f;  ///< first word of a frame: "OPL1"

/// Little endian: eight 32-bit words (kFrameMark, number, revision, step, width, height, channels of the layer, the
/// picture's time in microseconds), then R G B A of each pixel as halves, then the layer of each pixel as floats.
/// layer: as `opaline render --layers` names it; the frame has none where the picture lacks it
std::string pack_frame(const ViewPicture& picture, std::uint32_t number, const std::string& layer);

}  // namespace opaline
