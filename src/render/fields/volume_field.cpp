// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/fields/volume_field.h"

namespace opaline {
namespace {

constexpr double kSpacings = 1.3;  // of the samples: over which cells are interpolated

}  // namespace

VolumeField::VolumeField(const Body& body)
    : body_(body), samples_(body.surface.samples), radius_(float(kSpacings * body.surface.spacing())) {}

LeavingLight VolumeField::at(const SurfaceHits& hits, PointIrradianceInput, const Pass&,
                             HeldView::Surface*) const {
  LeavingLight light;
  for (const SurfacePoint& point : hits.points) {
    light.exitance.push_back(
        samples_.interpolate(body_.volume->exitance, point.position, point.geometric, radius_));
    light.error.push_back(
        samples_.interpolate(body_.volume->error, point.position, point.geometric, radius_));
  }
  return light;
}

}  // namespace opaline
