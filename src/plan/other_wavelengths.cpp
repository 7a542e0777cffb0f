// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/other_wavelengths.h"

namespace opaline {

Scene at_other_wavelengths(const Scene& scene, std::size_t index) {
  Scene other = scene.other_wavelengths[index];
  other.camera = scene.camera;
  other.film = scene.film;
  other.shutter = scene.shutter;
  other.settings = scene.settings;
  return other;
}

}  // namespace opaline
