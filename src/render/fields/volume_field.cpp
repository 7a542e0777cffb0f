// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/fields/volume_field.h"

#include <cmath>

namespace opaline {

LeavingLight VolumeField::at(const SurfaceHits& hits, PointIrradianceInput, const Pass&,
                             HeldView::Surface*) const {
  LeavingLight light;
  light.exitance.reserve(hits.points.size());
  light.error.reserve(hits.points.size());
  for (const SurfacePoint& point : hits.points) {
    const CellFit::Value found = body_.volume_fit->at(point.position, point.normal);
    light.exitance.push_back(found.value);
    RgbF error;
    for (std::size_t c = 0; c < 3; ++c) error[c] = std::hypot(found.noise[c], found.shape[c]);
    light.error.push_back(error);
  }
  return light;
}

}  // namespace opaline
