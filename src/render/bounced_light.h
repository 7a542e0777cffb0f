// SPDX-License-Identifier: GPL-3.0-or-later
// Indirect light between surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bodies/body.h"
#include "render/camera_rays.h"
#include "render/gathered_light.h"
#include "render/shade.h"

namespace opaline {

/// Irradiance cache for indirect light, in image space: 64 points along the longer side of the image, and
/// closer ones where near surfaces light each other and the irradiance varies. Includes a second bounce if
/// the bodies' trees contain indirect light; they do not in a Session's cache.
/// from  Ward, Rubinstein & Clear 1988
class BouncedPlaces {
 public:
  static constexpr std::size_t kBeside = 4;  ///< cache points of a row with a weight at a hit

  /// shader: without bounced light
  BouncedPlaces(const RenderInput& input, const Shader& shader);

  /// Interpolated indirect irradiance; none without a cache point on the point's tangent plane.
  std::optional<RgbF> at(const SurfacePoint& point, const OuterBoundary& boundary) const;

 private:
  /// Cache points, one array per coordinate for vector instructions.
  struct Places {
    std::vector<float> x, y, z, normal_x, normal_y, normal_z;
    std::vector<float> reach;     ///< distance from the tangent plane at which the weight is a half
    std::vector<float> boundary;  ///< OuterBoundary::number; below 0: no surface there

    /// Boundary and position of a query; dx, dy: to the first cache point of a row, in spacings.
    struct Asked {
      Vec3f point, normal;
      float boundary, dx, dy;
    };
    void resize(std::size_t count);
    void set(std::size_t i, const SurfacePoint& point, float number, float spacing);
    /// Weights of the cache points first, first + 1, ... of a row.
    std::array<float, kBeside> weights(const Asked& asked, std::size_t first) const;
  };
  /// Cache points over the whole image and a small margin, so a crop equals the same part of the full image;
  /// row by row.
  struct Lattice {
    int step;  ///< spacing, pixels
    int columns, rows;
    Places places;
    std::vector<RgbF> irradiance;
    std::vector<RgbF> further;   ///< its part by earlier bounces
    std::vector<RgbF> variance;  ///< squared standard error of the irradiance
    std::vector<float> met;      ///< share of rays with light
    std::vector<bool> is_near;   ///< true if the gathered surfaces are close, relative to the spacing

    Lattice(const Film& film, int pixels);
    std::array<double, 2> in_places(const CameraRays::FilmPlace& seen) const;
    /// True if a cache point around this position is near a surface and the irradiance varies.
    bool needs_closer_places(const CameraRays::FilmPlace& seen) const;
    std::optional<RgbF> at(const CameraRays::FilmPlace& seen, const SurfacePoint& point,
                           float boundary) const;
    /// Smooths `further`: its paths are noisier, and it varies less.
    void smooth_further();
    /// Smooths the irradiance within its noise: few rays meet a small bright place.
    void smooth_noise();

   private:
    /// Replaces values by combine(place, mean around it), several times.
    template <class Combine>
    void smooth(std::vector<RgbF>& values, int times, const Combine& combine) const;
    /// Mean of values at the places around a position, by their weights.
    std::optional<RgbF> mean(std::span<const RgbF> values, double x, double y, const Vec3f& point,
                             const Vec3f& normal, float boundary) const;
  };
  void gather(const RenderInput& input, const Shader& shader, Lattice& lattice,
              std::span<const std::uint32_t> places);
  void gather(const RenderInput& input, const Shader& shader, Lattice& lattice,
              std::span<const std::uint32_t> places, int rays_each, std::uint64_t first_key);
  std::vector<std::uint32_t> places_beside_near(const Lattice& coarse, const Lattice& fine) const;

  CameraRays camera_;
  std::vector<Lattice> lattices_;  // each with half the spacing of the last, where necessary
  std::size_t chunks_ = 0;         // chunks of gathered cache points
};

/// Irradiance at each body's samples from surfaces: translucent ones from their trees or cells, opaque ones
/// after all bounces between them; one list per body.
/// in    mirrored: light mirrored by the boundaries of bodies; view: cache with HeldView::at_samples for the same
///       samples, extended; or null
std::vector<std::vector<RgbF>> bounced_at_samples(const PrecomputeInput& input, std::span<const Body> bodies,
                                                  MirroredByBodies mirrored, HeldView* view = nullptr);

/// Indirect light at the hits of an image: from RenderInput::bounced, or from a cache of its own. Hits
/// without a usable cache point, as at silhouettes, gather rays themselves, with a second bounce if the
/// bodies' trees contain the first.
class BouncedLight {
 public:
  /// shader: without bounced light; both must outlive it
  BouncedLight(const RenderInput& input, const Shader& shader);

  /// Irradiance per hit, W/mm^2. held: cached results for the same hits, extended; or null
  std::vector<RgbF> at(const SurfaceHits& hits, const OuterBoundary& boundary,
                       HeldView::Surface* held = nullptr) const;

 private:
  const RenderInput& input_;
  const Shader& shader_;
  std::shared_ptr<const BouncedPlaces> places_;
};

}  // namespace opaline
