// SPDX-License-Identifier: GPL-3.0-or-later
// Surface with a diffusely reflecting fraction (1 - subsurface_weight) over the field of a translucent body.
#pragma once

#include <memory>

#include "subsurface/field.h"
#include "subsurface/render_input.h"

namespace opaline {

class PartlyOpaqueField : public Field {
 public:
  PartlyOpaqueField(const RenderInput& input, std::unique_ptr<Field> inside);

  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  OuterBoundary boundary() const override { return inside_->boundary(); }
  bool asks_irradiance() const override { return true; }
  bool reflects() const override { return true; }
  bool asks_samples() const override { return inside_->asks_samples(); }

 private:
  std::unique_ptr<Field> inside_;
  bool is_noisy_;
  int samples_per_pixel_;
};

}  // namespace opaline
