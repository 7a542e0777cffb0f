// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance of a body's samples: summed at the hits (dual_tree, classic, brute_force), or interpolated in its
// surface cache. Near fields with shadow edges are traced at the hits; points not covered by the cache are
// summed there.
#pragma once

#include <optional>

#include "bodies/surface_textures.h"
#include "methods/hierarchical/hierarchical_state.h"
#include "methods/hierarchical/near_field/near_field_sampler.h"
#include "subsurface/field.h"
#include "subsurface/render_input.h"

namespace opaline {

class SampleField : public Field {
 public:
  SampleField(const RenderInput& input, const Body& group);

  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  OuterBoundary boundary() const override { return group_.boundary; }
  bool asks_irradiance() const override { return asks_irradiance_; }
  bool asks_samples() const override { return true; }

 private:
  LeavingLight at_points(const SurfaceHits& hits, PointIrradianceInput lighting, bool looks_near,
                         HeldView::Surface* held) const;
  void replace_left(const SurfaceHits& hits, const PointIrradianceInput& lighting, LeavingLight& light) const;
  void put_exitance(std::span<const Exitance> exitance, LeavingLight& light) const;
  std::vector<Exitance> summed(const SurfaceHits& hits, std::span<const RgbF> irradiance,
                               QueryPackets* packets) const;
  std::vector<Exitance> looked_up(const SurfaceHits& hits, std::span<const RgbF> irradiance) const;
  void refine_near_field(const PointIrradianceInput& lighting, std::vector<Exitance>& exitance,
                         LeavingLight& light) const;

  const RenderInput& input_;
  const Body& group_;
  const HierarchicalState& state_;
  bool is_noisy_, asks_irradiance_;
  std::optional<SurfaceTextures> maps_;         ///< none: the body has no maps of normals and heights
  std::optional<NearFieldSampler> near_field_;  ///< none: samples or cache suffice
  RgbF creases_{};  ///< error of the near field at creases, over the exitance, as a standard deviation
};

}  // namespace opaline
