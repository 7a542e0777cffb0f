// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/fields/local_field.h"

#include "render/fields/make_fields.h"
#include "subsurface/method.h"

namespace opaline {

LocalField::LocalField(const RenderInput& input, std::span<const RgbF> albedos, const OuterBoundary& boundary)
    : albedos_(albedos.begin(), albedos.end()),
      boundary_(boundary),
      estimates_error_(method_of(input.scene.settings.method).layers().error),
      is_noisy_(has_area_lights(input.scene)),
      samples_per_pixel_(input.scene.film.samples_per_pixel) {}

LeavingLight LocalField::at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                            HeldView::Surface* held) const {
  LeavingLight light;
  if (estimates_error_) light.error.resize(hits.points.size());
  if (estimates_error_ && is_noisy_) light.noise.resize(hits.points.size());
  lighting.variance = light.noise;
  light.irradiance = irradiance_at_hits(lighting, pass.is_seen ? samples_per_pixel_ : 1, held);
  tint_entering(hits.textures, light.irradiance, light.noise);
  for (std::size_t i = 0; i < hits.points.size(); ++i) {
    const RgbF& albedo = albedos_[hits.hits[i].mesh];
    light.exitance.push_back(albedo * light.irradiance[i]);
    if (!light.noise.empty()) light.noise[i] = light.noise[i] * Rgb(albedo) * Rgb(albedo);
  }
  return light;
}

}  // namespace opaline
