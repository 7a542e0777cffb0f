// SPDX-License-Identifier: GPL-3.0-or-later
// `volume`: random walks inside the body, counted on the samples' cells and interpolated between them.
#pragma once

#include "opaline/render/render.h"
#include "render/fields/field.h"

namespace opaline {

class VolumeField : public Field {
 public:
  /// body: with its walks; must outlive the field, as the input
  VolumeField(const RenderInput& input, const Body& body);

  /// The error is the walks' noise and what interpolation between cells is off by.
  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  float eta() const override { return float(body_.profile.eta); }
  bool asks_irradiance() const override { return local_ != RgbF{}; }

 private:
  void add_local(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                 HeldView::Surface* held, LeavingLight& light) const;

  const Body& body_;
  /// Reflectance of the channels without a mean free path, which cells do not resolve: diffuse reflection at the hit.
  RgbF local_{};
  bool is_noisy_;
  int samples_per_pixel_;
};

}  // namespace opaline
