// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of an image that depend on the method.
#pragma once

namespace opaline {

/// Layers depending on the method.
struct MethodLayers {
  bool variance = false;  ///< variance of the mean, instead of the irradiance
  bool error = false;     ///< estimated standard error
};

}  // namespace opaline
