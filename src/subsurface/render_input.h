// SPDX-License-Identifier: GPL-3.0-or-later
// All inputs of an image.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "bodies/body.h"
#include "opaline/monitor.h"
#include "subsurface/held_view.h"

namespace opaline {

/// Irradiance cache of indirect light in image space.
class BouncedPlaces;

struct RenderInput {
  const Scene& scene;
  const World& world;
  const RayScene& rays;
  std::span<const Body> groups = {};  ///< bodies from the precompute; empty for methods without samples
  Monitor* monitor = nullptr;
  HeldView* view = nullptr;  ///< cached view of an earlier image, or new; at most kMostHeldBytes
  /// Indirect light gathered for this or another view of the same surfaces under the same light; null: render
  /// gathers it.
  std::shared_ptr<const BouncedPlaces> bounced = {};
  /// Numbers of progressive camera rays of an earlier image, per pixel; empty: the usual rays, or by settings.until_error.
  std::span<const std::uint16_t> adaptive_rays = {};
};

}  // namespace opaline
