// SPDX-License-Identifier: GPL-3.0-or-later
// From the hits of a batch of camera rays to radiance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "irradiance/irradiance.h"
#include "lights/light.h"
#include "render/appearance.h"
#include "render/camera_rays.h"
#include "render/fields/make_fields.h"
#include "render/layers.h"
#include "render/render.h"

namespace opaline {

class BouncedLight;

/// Specular reflection of bodies in gathered light: as of a uniform illumination, or of other surfaces alone, without
/// lights.
enum class MirroredByBodies { as_uniform, of_surfaces };

class Shader {
 public:
  /// sources: of meshes without a body. All arguments must outlive the object.
  explicit Shader(const RenderInput& input, std::span<const FieldSource> sources = {});

  /// For radiance_along.
  void set_mirrored_by_bodies(MirroredByBodies mirrored) { mirrored_by_bodies_ = mirrored; }

  /// Sets the width of camera rays for texture filtering as of this number per pixel, instead of the film's.
  void set_ray_width(int rays_per_pixel);

  /// Specular reflection at the hits: by rays, as of a uniform illumination, or none.
  enum class Specular { traced, uniform, none };
  /// Traced rays, shaded together.
  struct RayBatch {
    std::span<const TracedRay> rays;
    std::span<const std::uint64_t> keys;  ///< choose the random numbers of the rays' light samples
    std::span<PixelSample> out;           ///< one per ray
    int light_samples = 1;                ///< per hit
    /// Cone widths of the rays, for texture filtering: per length, and at the origins (empty: `width`).
    float spread = 0, width = 0;
    std::span<const float> widths = {};
    int mirrors = 0;  ///< number of specular reflections before
    Specular specular = Specular::traced;
    bool is_of_camera = false;
    std::span<RgbF> bounced_further = {};  ///< part of the diffuse radiance; empty: unused
  };
  RayBatch camera_batch(std::span<const TracedRay> rays, std::span<const std::uint64_t> keys,
                        std::span<PixelSample> out) const {
    return {.rays = rays,
            .keys = keys,
            .out = out,
            .light_samples = light_samples_,
            .spread = float(ray_width_.per_depth),
            .width = float(ray_width_.at_camera),
            .is_of_camera = true};
  }

  struct Shaded {
    std::vector<SurfaceHits> hits;  ///< one entry per field
    std::size_t queries = 0;        ///< number of points with exitance summed over samples
  };
  /// Adds the light of surfaces, and lights hit by rays.
  /// in    held: cached light transport of the batch, extended; or null
  Shaded shade(const RayBatch& batch, const Pass& pass, HeldView::Batch* held = nullptr) const;

  /// Outgoing radiance along rays that hit surfaces, W/(mm^2 sr): diffuse, and specular under an
  /// approximately uniform illumination. Traces one ray per light, and paths for light after further
  /// bounces between surfaces reflecting at the hit.
  /// in    held: cached light transport at these surfaces, extended; or null
  /// out   further: its part by earlier bounces
  std::vector<RgbF> radiance_along(std::span<const TracedRay> rays, std::span<const std::uint64_t> keys,
                                   HeldView::Batch* held, std::span<RgbF> further) const;

  /// Hits with light depending on the irradiance at the hit itself: exitance, or light of fuzz.
  struct SeenSurfaces {
    std::size_t field;
    SurfaceHits hits;
    OuterBoundary boundary;
  };
  std::vector<SeenSurfaces> surfaces_along(std::span<const TracedRay> rays,
                                           std::span<const std::uint64_t> keys) const;

  /// Sets the indirect light to be added at hits; null: none.
  void set_bounced_light(const BouncedLight* bounced) { bounced_ = bounced; }

  /// True if rays without a hit may see a light.
  bool has_visible_lights() const {
    return !seen_.emitters.empty() || !seen_.surroundings.empty() || seen_.backdrop != RgbF{};
  }

 private:
  /// Lights visible to rays.
  struct MetLights {
    std::vector<Light> emitters;      ///< those with an area
    std::vector<Light> surroundings;  ///< environments
    RgbF backdrop{};

    void add(const Light& light);
    EmitterHit nearest(const Vec3f& origin, const Vec3f& direction, float far) const;
    RgbF radiance(const Vec3f& direction) const;
  };

  /// Reflected rays and their cones.
  struct Cones {
    float spread = 0;
    std::vector<float> widths;  ///< empty: unused
  };
  struct GlossyHits;

  /// in    catchers: receives the camera's hits on shadow catchers
  std::vector<SurfaceHits> collect(const RayBatch& batch, HeldView::Batch* held, SurfaceHits& catchers) const;
  /// The background behind shadow catchers, and its darkening.
  void add_shadows(const SurfaceHits& catchers, const RayBatch& batch) const;
  void add_textures(const RayBatch& batch, std::size_t ray, bool from_behind, SurfacePoint& point,
                    SurfaceHits& hits) const;
  /// Emission of the shape hit by a ray.
  RgbF emitted_towards(const RayBatch& batch, std::size_t ray, const SurfacePoint& point) const;
  Appearance appearance_of(const SurfaceHits& hits, std::size_t i) const;
  /// Light from other surfaces at hits; empty: none.
  std::vector<RgbF> bounced_at(const SurfaceHits& hits, const OuterBoundary& boundary, const Pass& pass,
                               HeldView::Surface* held) const;
  /// The same at hits of gathered rays: by one ray from some of them, chosen in proportion to the albedo of surface or fuzz.
  std::vector<RgbF> bounced_further(const SurfaceHits& hits, const OuterBoundary& boundary,
                                    HeldView::Surface* held) const;
  void write(const SurfaceHits& hits, const LeavingLight& light, std::span<const TracedRay> rays,
             std::span<PixelSample> out) const;
  static void write_further(const SurfaceHits& hits, std::span<const RgbF> bounced, const RayBatch& batch);
  /// Light reflected by fibres.
  /// in    arriving: light from other surfaces transmitted by the boundary, at each hit; empty: none
  void add_fuzz(const SurfaceHits& hits, const OuterBoundary& boundary, std::span<const RgbF> arriving,
                const RayBatch& batch) const;
  // Specular reflection: shade_specular.cpp.
  void add_specular(const SurfaceHits& hits, const RayBatch& batch, const Pass& pass,
                    HeldView::Surface* held) const;
  void add_mirrored(const SurfaceHits& hits, const RayBatch& batch, const Pass& pass) const;
  bool can_hold_coats() const;
  void add_glossy(const SurfaceHits& hits, const RayBatch& batch, const Pass& pass,
                  HeldView::Surface* held) const;
  void add_held_coat(HeldView::Coat& coat, const RayBatch& batch, const Pass& pass) const;
  void add_highlights(const GlossyHits& glossy, HeldView::Coat* coat) const;
  void add_reflections(const GlossyHits& glossy, const Pass& pass, HeldView::Coat* coat) const;
  std::vector<PixelSample> seen_along(std::span<const TracedRay> rays, std::span<const std::uint64_t> keys,
                                      const Cones& cones, const Pass& pass, int mirrors,
                                      HeldView::Batch* held = nullptr) const;
  /// Specular reflection without rays, of an irradiance taken as uniform over the hemisphere.
  void add_evenly_mirrored(const SurfaceHits& hits, const RayBatch& batch) const;
  void add_mirrored_surfaces(const SurfaceHits& hits, const RayBatch& batch) const;
  float width_at(const RayBatch& batch, std::size_t ray) const;
  bool mirrors_surfaces() const {
    return !met_.emitters.empty() || !met_.surroundings.empty() || input_.scene.shapes.size() > 1;
  }

  const RenderInput& input_;
  MirroredByBodies mirrored_by_bodies_ = MirroredByBodies::as_uniform;
  std::vector<Light> lights_;                        // recentred
  std::vector<RgbF> emitted_;                        // one per light
  MetLights met_, seen_;                             // by any ray, by those of the camera
  std::vector<std::vector<ShapeLight>> emitted_by_;  // one per shape; empty: no shape emits
  std::vector<Light> unit_lights_;                   // all with unit emission, if reflections are cacheable
  std::vector<Appearance> appearances_;              // one per mesh
  SurfaceTextures textures_;
  PixelWidth ray_width_;  // for camera rays
  Fields fields_;
  int light_samples_ = 1;  // a camera ray
  const BouncedLight* bounced_ = nullptr;
};

}  // namespace opaline
