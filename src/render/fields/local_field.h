// SPDX-License-Identifier: GPL-3.0-or-later
// Diffuse reflection at the hit: opaque surfaces, and `lambert`, the limit of a vanishing mean free path.
#pragma once

#include "subsurface/field.h"
#include "subsurface/render_input.h"

namespace opaline {

class LocalField : public Field {
 public:
  /// albedos: of each mesh of the world, the reflectance or the total diffuse reflectance.
  LocalField(const RenderInput& input, std::span<const RgbF> albedos, const OuterBoundary& boundary);

  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  OuterBoundary boundary() const override { return boundary_; }
  bool asks_irradiance() const override { return true; }
  bool reflects() const override { return true; }

 private:
  std::vector<RgbF> albedos_;
  OuterBoundary boundary_;
  bool estimates_error_, is_noisy_;
  int samples_per_pixel_;
};

}  // namespace opaline
