// SPDX-License-Identifier: GPL-3.0-or-later
// From the hits of a batch of camera rays to radiance.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "opaline/irradiance/irradiance.h"
#include "opaline/lights/light.h"
#include "opaline/render/render.h"
#include "render/entry_sampler.h"
#include "render/layers.h"
#include "render/near_field_sampler.h"

namespace opaline {

/// What a mesh looks like: opaque of some reflectance, or translucent with a profile.
struct Appearance {
  bool translucent = false;
  RgbF albedo{};                            ///< reflectance, or total diffuse reflectance
  float eta = 1;                            ///< translucent only
  float average_reflectance = 0;            ///< F_bar
  const TranslucentGroup* group = nullptr;  ///< of the samples to sum
  const EntrySampler* entries = nullptr;    ///< or to draw entry points with; neither: plain Lambert
  std::size_t kind = 0;                     ///< of the shader's kinds
};

/// One of several independent estimates of the same picture; only `direct` makes more than one.
struct Pass {
  std::uint64_t index = 0;
  int entry_samples = 0;  ///< of each camera ray
};

class Shader {
 public:
  /// entry_samplers: of Method::direct, one a group.
  explicit Shader(const RenderInput& input, std::span<const EntrySampler> entry_samplers = {});

  /// Shades a batch of traced camera rays, one PixelSample a ray. keys: one a ray, for its light samples.
  /// held: how lights reach what the rays met, added to, or null. Returns the number of exitance queries.
  std::size_t shade(std::span<const TracedRay> rays, std::span<const std::uint64_t> keys,
                    std::span<PixelSample> out, const Pass& pass, HeldView::Batch* held = nullptr) const;

  /// False where rays that hit nothing see nothing either.
  bool has_visible_lights() const { return !emitters_.empty() || !surroundings_.empty(); }

 private:
  // Surfaces whose exitance is found in one go: of a group, or with one boundary.
  struct Kind {
    const TranslucentGroup* group;
    const EntrySampler* entries;  // neither: exitance is local
    float eta;                    // 0: opaque
    friend bool operator==(const Kind&, const Kind&) = default;
  };
  // The hits of one kind in a batch.
  struct Surfaces {
    std::vector<SurfacePoint> points;
    std::vector<std::uint64_t> keys;
    std::vector<std::uint32_t> rays;  // their places in the batch
  };
  struct Lit {
    std::vector<RgbF> exitance;           // empty: albedo x irradiance
    std::vector<RgbF> irradiance, error;  // empty: not known
    std::vector<Rgb> noise;               // variance of the exitance at each point by itself; empty: none
    std::vector<RgbF> bias;               // that the noise gives the exitance; empty: none
  };

  std::vector<Surfaces> collect(std::span<const TracedRay> rays, std::span<const std::uint64_t> keys,
                                std::span<PixelSample> out, HeldView::Batch* held) const;
  Lit light(const Kind& kind, const Surfaces& surfaces, std::span<const TracedRay> rays, const Pass& pass,
            HeldView::Surface* held) const;
  Lit evaluated(const Kind& kind, const Surfaces& surfaces, std::span<const TracedRay> rays,
                HeldView::Surface* held) const;
  std::vector<Exitance> summed(const TranslucentGroup& group, const Surfaces& surfaces, const Lit& lit,
                               QueryPackets* packets) const;
  static std::vector<Exitance> interpolated(const SurfaceCache& cache, const Surfaces& surfaces,
                                            const Lit& lit, std::span<const TracedRay> rays);
  RgbF surroundings(const Vec3f& direction) const;
  PointIrradianceInput lighting_of(const Surfaces& surfaces, float eta) const;
  void write(const Surfaces& surfaces, const Lit& lit, std::span<const TracedRay> rays,
             std::span<PixelSample> out) const;
  void add_mirrored_lights(const Surfaces& surfaces, std::span<const TracedRay> rays,
                           std::span<PixelSample> out) const;
  EmitterHit nearest_emitter(const Vec3f& origin, const Vec3f& direction, float far) const;

  const RenderInput& input_;
  std::vector<Light> lights_;                                 // recentred
  std::vector<Light> emitters_;                               // those with an area
  std::vector<Light> surroundings_;                           // those all around
  std::vector<std::optional<NearFieldSampler>> near_fields_;  // one a group; none where samples tell all
  std::vector<RgbF> creases_;  // one a group: systematic error of the picture's near fields, relative
  std::vector<Appearance> appearances_;  // one a mesh
  std::vector<Kind> kinds_;
};

}  // namespace opaline
