// SPDX-License-Identifier: GPL-3.0-or-later
// Measured media by name.
#pragma once

#include <span>
#include <string_view>

#include "opaline/scene.h"

namespace opaline {

struct Preset {
  std::string_view name;
  PhysicalMedium coefficients;
  double eta;
};

/// The twelve materials of Jensen et al. 2001, A Practical Model for Subsurface Light Transport, figure 5.
std::span<const Preset> presets();
/// Their names, in the same order.
std::span<const std::string_view> preset_names();

}  // namespace opaline
