// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance depending on the irradiance at a point itself, for surface caches.
#pragma once

#include <span>
#include <vector>

#include "methods/hierarchical/near_field/near_field_sampler.h"
#include "opaline/exitance/surface_cache.h"
#include "opaline/render/precompute.h"

namespace opaline {

/// True if a cache can store the exitance depending on the point's own irradiance, so images trace no shadow
/// rays. Excludes meshes without smooth normals, whose facets differ in irradiance; mean free paths far below
/// the sample spacing, whose shadows are too sharp to interpolate; and bounced light, computed at the image's
/// points only.
bool can_hold_own_light(const Scene& scene, const World& world, const Body& group);

/// Adds this exitance at the shader's points. Beside shadow edges, an explicitly requested cache leaves it to
/// the points, to meet its tolerance; an automatic one, made for speed, stores the estimate of a few shadow
/// rays.
class OwnLight {
 public:
  /// Both must outlive the object.
  OwnLight(const PrecomputeInput& input, const Body& group);

  /// As AddOwnLight.
  void add(std::span<const SurfacePoint> points, std::span<Exitance> exitance,
           std::span<PlaceDoubt> doubts) const;

 private:
  void add_to_chunk(std::span<const SurfacePoint> points, std::span<Exitance> exitance,
                    std::span<PlaceDoubt> doubts) const;

  const PrecomputeInput& input_;
  const Body& group_;
  std::vector<Light> lights_;
  NearFieldSampler near_field_;
  bool holds_edges_;
};

}  // namespace opaline
