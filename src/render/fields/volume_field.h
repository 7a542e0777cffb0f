// SPDX-License-Identifier: GPL-3.0-or-later
// `volume`: random walks inside the body, counted on the samples' cells and interpolated between them.
#pragma once

#include "opaline/render/precompute.h"
#include "render/fields/field.h"

namespace opaline {

class VolumeField : public Field {
 public:
  /// body: with its walks; must outlive the field
  explicit VolumeField(const Body& body) : body_(body) {}

  /// The error is the walks' noise and what interpolation between cells is off by.
  LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                  HeldView::Surface* held) const override;
  float eta() const override { return float(body_.profile.eta); }

 private:
  const Body& body_;
};

}  // namespace opaline
