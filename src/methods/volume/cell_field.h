// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance interpolated between means over the samples' cells.
#pragma once

#include "subsurface/field.h"
#include "subsurface/render_input.h"
#include "volume/cell_fit.h"

namespace opaline {

class CellField : public Field {
 public:
  /// local: diffuse reflectance of channels without a mean free path, which is below the resolution of cells;
  /// 0 in the others. All must outlive the field.
  CellField(const RenderInput& input, const Body& body, const CellFit& fit, const RgbF& local);

  /// The error is the sum of the means' noise and the interpolation error.
  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  OuterBoundary boundary() const override { return body_.boundary; }
  bool asks_irradiance() const override { return local_ != RgbF{}; }
  bool reflects() const override { return asks_irradiance(); }

 private:
  void add_local(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                 HeldView::Surface* held, LeavingLight& light) const;

  const Body& body_;
  const CellFit& fit_;
  RgbF local_;
  bool is_noisy_;
  int samples_per_pixel_;
};

}  // namespace opaline
