// SPDX-License-Identifier: GPL-3.0-or-later
#include "subsurface/planning.h"

#include <fmt/format.h>

#include "lights/light_tree.h"

namespace opaline {

Lighting lighting_of(const Scene& scene) {
  Lighting all;
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    const bool is_point = is_delta(scene.lights[l]);
    all.directions += is_point ? 1 : 8;
    if (l > 0 && share_rays(scene.lights[l - 1], scene.lights[l])) continue;
    all.rays += shadow_rays(scene.lights[l], scene.settings.light_samples);
    all.lights += 1;
    if (!is_point) all.extended_lights += 1;
  }
  return all;
}

double needle_fraction(const World& world, const BodyPlan& body) {
  double needles = 0, area = 0;
  for (const std::uint32_t m : body.meshes) {
    needles += world.measures[m].needle_area;
    area += world.measures[m].area;
  }
  return area > 0 ? needles / area : 0;
}

std::string irradiance_stage(const Scene& scene, std::span<const Light> traced) {
  std::size_t lights = 0, rays = 0, drawn_from = 0;
  for (std::size_t l = 0; l < traced.size(); ++l) {
    if (l > 0 && share_rays(traced[l - 1], traced[l])) continue;
    const auto* many = std::get_if<ManyLights>(&traced[l].source);
    lights += many != nullptr ? many->tree->lights().size() : 1;
    drawn_from += many != nullptr ? many->tree->lights().size() : 0;
    rays += std::size_t(shadow_rays(traced[l], scene.settings.light_samples));
  }
  const std::string drawn =
      drawn_from > 0 ? fmt::format(", by importance sampling of {} lights", drawn_from) : "";
  return fmt::format("irradiance: {} light{}, {} shadow ray{} per sample{}", lights, lights == 1 ? "" : "s",
                     rays, rays == 1 ? "" : "s", drawn);
}

}  // namespace opaline
