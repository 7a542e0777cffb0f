// SPDX-License-Identifier: GPL-3.0-or-later
// Image layers depending on the method.
#pragma once

namespace opaline {

/// Flags of the layers written by a method.
struct MethodLayers {
  bool variance = false;  ///< variance of the mean, instead of the irradiance
  bool error = false;     ///< estimated standard error
};

}  // namespace opaline
