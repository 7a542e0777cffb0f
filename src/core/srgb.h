// SPDX-License-Identifier: GPL-3.0-or-later
// sRGB's transfer function.
#pragma once

#include <cmath>

namespace opaline {

/// Linear value of an encoded one, both 1 at white. from IEC 61966-2-1
inline double srgb_to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace opaline
