// SPDX-License-Identifier: GPL-3.0-or-later
// Light that surfaces send to other surfaces.
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

/// Gathered at what a camera sees at 64 places along its picture's longer side, and at closer ones where surfaces are near
/// to each other and their light varies. Where bodies' trees hold what bounced to them, so does what they send here, a
/// second bounce: a Session's do not while it gathers.
/// from  Ward, Rubinstein & Clear 1988
class BouncedPlaces {
 public:
  static constexpr std::size_t kBeside = 4;  ///< places of a row that may stand for a point

  /// shader: without bounced light
  BouncedPlaces(const RenderInput& input, const Shader& shader);

  /// Between places on the plane of the point; none where no place stands for it.
  std::optional<RgbF> at(const SurfacePoint& point, float eta) const;

 private:
  /// An array for each of their numbers, to weigh some at once.
  struct Places {
    std::vector<float> x, y, z, normal_x, normal_y, normal_z;
    std::vector<float> reach;  ///< off the plane, where they stand for a point half as well
    std::vector<float> eta;    ///< below 0: no surface there

    /// Boundary and position of a query; dx, dy: to the first place of a row, in places.
    struct Asked {
      Vec3f point, normal;
      float eta, dx, dy;
    };
    void resize(std::size_t count);
    void set(std::size_t i, const SurfacePoint& point, float boundary, float spacing);
    /// How well places first, first + 1, ... of a row stand for a point.
    std::array<float, kBeside> weights(const Asked& asked, std::size_t first) const;
  };
  /// Places over the picture and a little around it, so a crop is a piece of it; row after row.
  struct Lattice {
    int step;  ///< pixels from one place to the next
    int columns, rows;
    Places places;
    std::vector<RgbF> irradiance;
    std::vector<bool> is_near;  ///< to what they gather from, for so few of them

    Lattice(const Film& film, int pixels);
    std::array<double, 2> in_places(const CameraRays::FilmPlace& seen) const;
    /// True if a place around this one is near, and their light varies.
    bool needs_closer_places(const CameraRays::FilmPlace& seen) const;
    std::optional<RgbF> at(const CameraRays::FilmPlace& seen, const SurfacePoint& point, float eta) const;
  };
  void gather(const RenderInput& input, const Shader& shader, Lattice& lattice,
              std::span<const std::uint32_t> places);
  std::vector<std::uint32_t> places_beside_near(const Lattice& coarse, const Lattice& fine) const;

  CameraRays camera_;
  std::vector<Lattice> lattices_;  // each of places half as far apart as the last, where that needs them
  std::size_t chunks_ = 0;         // chunks of places that gathered
};

/// Irradiance at each body's samples from surfaces, translucent ones as their trees have it and opaque ones as lights
/// alone light them; one list a body. view: where HeldView::at_samples are of the same samples, added to; or null
std::vector<std::vector<RgbF>> bounced_at_samples(const PrecomputeInput& input, std::span<const Body> bodies,
                                                  HeldView* view = nullptr);

/// At the hits of a picture: by RenderInput::bounced, or places of its own. Hits that no place stands for, at rims, gather
/// for themselves, with a second bounce where trees hold the first.
class BouncedLight {
 public:
  /// shader: without bounced light; both must outlive it
  BouncedLight(const RenderInput& input, const Shader& shader);

  /// One a hit, W/mm^2. held: of the same hits, added to, or null
  std::vector<RgbF> at(const SurfaceHits& hits, float eta, HeldView::Surface* held = nullptr) const;

 private:
  const RenderInput& input_;
  const Shader& shader_;
  std::shared_ptr<const BouncedPlaces> places_;
};

}  // namespace opaline
