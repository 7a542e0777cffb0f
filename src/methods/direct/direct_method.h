// SPDX-License-Identifier: GPL-3.0-or-later
// `direct`: the BSSRDF, importance-sampled at each hit (render_direct); unbiased and noisy.
#pragma once

#include "subsurface/method.h"

namespace opaline {

class DirectMethod : public SubsurfaceMethod {
 public:
  bool needs_samples() const override { return false; }
  MethodLayers layers() const override { return {.variance = true, .error = false}; }
  bool separates_lights() const override { return false; }
  double seconds_of_pixel(const Scene& scene, const Lighting& lighting) const override;
  std::string bounces_stage() const override;
  std::string shading_stage(const Scene& scene) const override;
  std::optional<RenderResult> render_image(const PrecomputeInput& input) const override;
};

}  // namespace opaline
