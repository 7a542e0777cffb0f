// SPDX-License-Identifier: GPL-3.0-or-later
// Media by name: measured ones, and looks chosen by eye.
#pragma once

#include <span>
#include <string_view>

#include "opaline/scene.h"

namespace opaline {

struct Preset {
  std::string_view name;
  PhysicalMedium coefficients;
  double eta;
  double roughness = 0;  ///< specular_roughness without this key
};

/// specular_roughness of a measured preset chosen for an object by its name alone: by --medium, or on the page.
inline constexpr double kMeasuredRoughness = 0.3;

/// The twelve materials of Jensen et al. 2001, A Practical Model for Subsurface Light Transport, figure 5.
std::span<const Preset> measured_presets();
/// These, and then the looks: diffuse reflectance and mean free path by eye, for objects of some centimetres.
std::span<const Preset> presets();
/// Names of presets().
std::span<const std::string_view> preset_names();

}  // namespace opaline
