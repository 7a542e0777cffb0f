// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of linear colours between RGB spaces.
#pragma once

#include <array>

#include "opaline/vec3.h"

namespace opaline {

/// CIE 1931 xy of the primaries and the white.
struct RgbPrimaries {
  std::array<double, 2> red, green, blue, white;
};

/// ITU-R BT.709-6, white D65.
inline constexpr RgbPrimaries kRec709Primaries{{.64, .33}, {.30, .60}, {.15, .06}, {.3127, .3290}};
/// AP1, the primaries of ACEScg, with the white of ACES. from SMPTE ST 2065-1, Academy S-2014-004
inline constexpr RgbPrimaries kAp1Primaries{{.713, .293}, {.165, .830}, {.128, .044}, {.32168, .33766}};

/// Each row gives one channel of the result, as weights of the source channels.
using ColorMatrix = std::array<Vec3d, 3>;

/// Conversion of linear colours between two spaces; white stays white (Bradford adaptation).
/// from  SMPTE RP 177 (RGB to XYZ); Lam 1985
ColorMatrix color_matrix(const RgbPrimaries& from, const RgbPrimaries& to);

/// Conversion of XYZ to linear colours of a space, without adaptation of white.
ColorMatrix xyz_to_rgb(const RgbPrimaries& space);

inline Vec3d operator*(const ColorMatrix& m, const Vec3d& color) {
  return {dot(m[0], color), dot(m[1], color), dot(m[2], color)};
}

}  // namespace opaline
