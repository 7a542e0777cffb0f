// SPDX-License-Identifier: GPL-3.0-or-later
// The light of a surface depending on the irradiance at each place itself, for surface caches.
#pragma once

#include <span>
#include <vector>

#include "bodies/body.h"
#include "exitance/surface_cache.h"
#include "methods/hierarchical/near_field/near_field_sampler.h"

namespace opaline {

/// True if a cache can hold the light depending on the irradiance at each place, so pictures trace no
/// shadow rays: facets without smooth normals are lit each in its own way, and the shadows of a mean free
/// path far below the sample spacing are too sharp to interpolate; light that bounces is known at the picture's points.
bool can_hold_own_light(const Scene& scene, const World& world, const Body& group);

/// The light that the shader adds at its points. Beside shadow edges a cache that the settings ask for leaves it to the
/// points, so its tolerance holds; one that `automatic` takes for its speed holds what a few shadow rays tell.
class OwnLight {
 public:
  /// Both must outlive it.
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
