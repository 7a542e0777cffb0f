// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/other_wavelengths.h"

#include "lights/light.h"

namespace opaline {

Scene at_other_wavelengths(const Scene& scene, std::size_t index) {
  Scene other = scene.other_wavelengths[index];
  other.camera = scene.camera;
  other.film = scene.film;
  other.shutter = scene.shutter;
  other.settings = scene.settings;
  for (std::size_t l = 0; l < other.lights.size() && l < scene.lights.size(); ++l)
    if (emission(scene.lights[l]) == Rgb{}) other.lights[l] = with_emission(other.lights[l], {});
  return other;
}

}  // namespace opaline
