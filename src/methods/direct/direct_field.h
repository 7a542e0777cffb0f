// SPDX-License-Identifier: GPL-3.0-or-later
// Field of `direct`: entry points sampled at random, unbiased and noisy.
#pragma once

#include "methods/direct/direct_exitance.h"
#include "subsurface/field.h"

namespace opaline {

class DirectField : public Field {
 public:
  DirectField(const EntrySampler& sampler, const SurfaceTextures& textures, const OuterBoundary& boundary)
      : sampler_(sampler), textures_(textures), boundary_(boundary) {}

  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface*) const override {
    return {.exitance = direct_exitance(
                {sampler_, lighting, pass.entry_samples, &textures_, hits.hits, pass.gathers}),
            .irradiance = {},
            .error = {},
            .noise = {},
            .bias = {},
            .is_tinted = false};
  }
  OuterBoundary boundary() const override { return boundary_; }

 private:
  const EntrySampler& sampler_;
  const SurfaceTextures& textures_;
  OuterBoundary boundary_;
};

}  // namespace opaline
