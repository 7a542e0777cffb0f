// SPDX-License-Identifier: GPL-3.0-or-later
// `volume`: random walks inside the body, counted on the samples' cells and interpolated between them.
#pragma once

#include "opaline/render/precompute.h"
#include "opaline/volume/nearest_sample.h"
#include "render/fields/field.h"

namespace opaline {

class VolumeField : public Field {
 public:
  /// body: with its walks; must outlive the field
  explicit VolumeField(const Body& body);

  /// The error is the walks' noise; what interpolation between cells blurs is not in it.
  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  float eta() const override { return float(body_.profile.eta); }

 private:
  const Body& body_;
  NearestSample samples_;
  float radius_;
};

}  // namespace opaline
