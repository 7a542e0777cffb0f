// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance of a surface at hits, and its error. Methods make the fields of bodies; render/fields/ has the fields of
// surfaces without one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"
#include "irradiance/irradiance.h"
#include "subsurface/held_view.h"
#include "subsurface/hit_textures.h"

namespace opaline {

class Shader;

/// One of several independent estimates of the same image; only `direct` makes more than one.
struct Pass {
  std::uint64_t index = 0;
  int entry_samples = 0;  ///< entry samples of each camera ray
  bool is_seen = true;    ///< false: for gathered rays; without a near field
  /// `direct`: gathering of light from other surfaces at points of entry, by one ray each; null: direct light
  /// only.
  const Shader* gathers = nullptr;
  /// The same for surfaces visible in specular reflections; null: the same.
  const Pass* in_mirrors = nullptr;
};

/// Hits of a batch of camera rays in one field, one entry per hit in each array.
struct SurfaceHits {
  std::vector<SurfacePoint> points;
  std::vector<Hit> hits;              ///< mesh, triangle, barycentrics
  std::vector<std::uint64_t> keys;    ///< choose the random numbers of a hit
  std::vector<std::uint32_t> rays;    ///< their indices in the batch
  std::vector<HitTextures> textures;  ///< empty: the scene has none
};

/// Outgoing light, one entry per hit, W/mm^2; an array is empty if the field does not compute it.
struct LeavingLight {
  std::vector<RgbF> exitance;    ///< radiant exitance M_o, without the factor SurfaceTint::leaving
  std::vector<RgbF> irradiance;  ///< E at the hit
  std::vector<RgbF> error;       ///< standard error of the exitance, shared by neighbouring hits
  std::vector<Rgb> noise;        ///< variance of the exitance of each hit
  std::vector<RgbF> bias;        ///< bias of the exitance from noise
  bool is_tinted = false;        ///< the factor is included in all of them
};

class Field {
 public:
  virtual ~Field() = default;
  /// in    lighting: of the hits' points, with the boundary()
  ///       held: cached results for the same hits, extended; or null
  virtual LeavingLight at(const SurfaceHits& hits, PointIrradianceInput lighting, const Pass& pass,
                          HeldView::Surface* held) const = 0;
  virtual OuterBoundary boundary() const = 0;
  /// True if the exitance depends on the irradiance at the hits themselves.
  virtual bool asks_irradiance() const { return false; }
  /// True if a part of the exitance at any hit is reflected irradiance.
  virtual bool reflects() const { return false; }
  /// True if the exitance is summed over samples, point by point.
  virtual bool asks_samples() const { return false; }
};

/// Irradiance at the hits, from lights by shadow rays unless cached, and from other surfaces; without tints.
/// The camera rays of a pixel, numbered by their keys, share one set of light samples.
std::vector<RgbF> irradiance_at_hits(const PointIrradianceInput& lighting, int samples_per_pixel,
                                     HeldView::Surface* held);

/// Transmitted irradiance and its variance: tinted.
void tint_entering(std::span<const HitTextures> textures, std::span<RgbF> irradiance,
                   std::span<Rgb> variance);

}  // namespace opaline
