// SPDX-License-Identifier: GPL-3.0-or-later
// From the hits of a batch of camera rays to radiance.
#pragma once

#include <span>
#include <vector>

#include "opaline/irradiance/light_sampling.h"
#include "opaline/render/render.h"
#include "render/layers.h"

namespace opaline {

/// What a mesh looks like: opaque of some reflectance, or translucent with a profile.
struct Appearance {
  bool translucent = false;
  RgbF albedo{};                  ///< reflectance, or total diffuse reflectance
  float eta = 1;                  ///< translucent only
  float average_reflectance = 0;  ///< F_bar
  const TranslucentGroup* group = nullptr;  ///< null: plain Lambert
};

class Shader {
 public:
  explicit Shader(const RenderInput& input);

  /// Shades a batch of camera rays, one PixelSample a ray. keys: one a ray, for its light samples.
  /// Returns the number of exitance queries.
  std::size_t shade(std::span<const Ray> rays, std::span<const Hit> hits, std::span<const std::uint64_t> keys,
                    std::span<PixelSample> out) const;

 private:
  struct Surface {
    std::size_t ray;
    SurfacePoint point;
    const Appearance* appearance;
    float cos_view;  // between shading normal and the way back to the camera
    RgbF exitance;
  };

  Surface surface_at(std::size_t ray, const Ray& camera_ray, const Hit& hit) const;
  void add_lambert(std::vector<Surface>& surfaces, std::span<const std::uint64_t> keys,
                   std::span<PixelSample> out) const;
  std::size_t add_translucent(std::vector<Surface>& surfaces, std::span<const std::uint64_t> keys,
                              std::span<PixelSample> out) const;
  void add_mirrored_lights(const std::vector<Surface>& surfaces, std::span<const Ray> rays,
                           std::span<PixelSample> out) const;
  EmitterHit nearest_emitter(const Vec3f& origin, const Vec3f& direction, float far) const;
  std::vector<RgbF> irradiance(const std::vector<const Surface*>& surfaces, std::span<const std::uint64_t> keys,
                               double eta) const;

  const RenderInput& input_;
  std::vector<Light> lights_;    // recentred
  std::vector<Light> emitters_;  // those with an area
  RgbF surroundings_{};
  std::vector<Appearance> appearances_;  // one a mesh
};

}  // namespace opaline
