// SPDX-License-Identifier: GPL-3.0-or-later
// Tone mapping of colours above white.
#pragma once

#include "opaline/enumerations.h"
#include "opaline/vec3.h"

namespace opaline {

/// Displayed linear Rec.709 colour, each channel 0 to 1.
/// in    linear Rec.709, white 1, after exposure; finite
/// from  neutral: Khronos Group 2024, PBR Neutral Tone Mapper specification; soft: its highlights without its
///       offset; agx: Sobotka 2022, AgX, by the polynomial of Wrensch 2023, Minimal AgX Implementation
RgbF shown_color(ViewTransform view, const RgbF& linear);

}  // namespace opaline
