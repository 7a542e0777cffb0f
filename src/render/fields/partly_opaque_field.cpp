// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/fields/partly_opaque_field.h"

#include <cmath>
#include <utility>

#include "render/fields/make_fields.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

/// Tints the exitance of light from inside.
void tint_leaving(std::span<const HitTextures> textures, LeavingLight& light) {
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const RgbF& tint = textures[i].tint.leaving;
    light.exitance[i] = light.exitance[i] * tint;
    if (!light.error.empty()) light.error[i] = light.error[i] * tint;
    if (!light.noise.empty()) light.noise[i] = light.noise[i] * Rgb(tint) * Rgb(tint);
    if (!light.bias.empty()) light.bias[i] = light.bias[i] * tint;
  }
  light.is_tinted = true;
}

}  // namespace

PartlyOpaqueField::PartlyOpaqueField(const RenderInput& input, std::unique_ptr<Field> inside)
    : inside_(std::move(inside)),
      is_noisy_(method_of(input.scene.settings.method).layers().error && has_area_lights(input.scene)),
      samples_per_pixel_(input.scene.film.samples_per_pixel) {}

LeavingLight PartlyOpaqueField::at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                                   HeldView::Surface* held) const {
  LeavingLight light = inside_->at(hits, lighting, pass, held);
  tint_leaving(hits.textures, light);
  std::vector<Rgb> variance(is_noisy_ ? hits.points.size() : 0);
  lighting.variance = variance;
  light.irradiance = irradiance_at_hits(lighting, pass.is_seen ? samples_per_pixel_ : 1, held);
  if (is_noisy_) light.noise.resize(hits.points.size());
  for (std::size_t i = 0; i < hits.points.size(); ++i) {
    const RgbF& reflected = hits.textures[i].reflected;
    light.exitance[i] += reflected * light.irradiance[i];
    if (!is_noisy_) continue;
    // The same shadow rays may be in both: their deviations add up.
    for (std::size_t c = 0; c < 3; ++c) {
      const double deviation =
          std::sqrt(light.noise[i][c]) + double(reflected[c]) * std::sqrt(variance[i][c]);
      light.noise[i][c] = deviation * deviation;
    }
  }
  return light;
}

}  // namespace opaline
