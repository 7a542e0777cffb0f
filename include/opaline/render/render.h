// SPDX-License-Identifier: GPL-3.0-or-later
// Rendering of an image from a prepared scene.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "opaline/core/monitor.h"
#include "opaline/image/image.h"
#include "opaline/render/held_view.h"
#include "opaline/render/precompute.h"

namespace opaline {

/// Pixels [x0, x1) x [y0, y1) of the full image.
struct Rectangle {
  int x0, y0, x1, y1;
};

/// Rendered rectangle: the crop of the film, or the whole film.
Rectangle rendered_part(const Film& film);

/// Irradiance cache of indirect light in image space.
class BouncedPlaces;

struct RenderInput {
  const Scene& scene;
  const World& world;
  const RayScene& rays;
  std::span<const Body> groups = {};  ///< bodies from the precompute; not needed by Method::lambert
  Monitor* monitor = nullptr;
  HeldView* view = nullptr;  ///< cached view of an earlier image, or new; at most kMostHeldBytes
  /// Indirect light gathered for this or another view of the same surfaces under the same light; null: render
  /// gathers it.
  std::shared_ptr<const BouncedPlaces> bounced = {};
};

/// Maximum size of a cached view, bytes.
inline constexpr std::size_t kMostHeldBytes = std::size_t(256) << 20;
inline constexpr std::size_t kMostCoatBytes = std::size_t(256) << 20;  ///< in addition, for HeldView::Coat

struct RenderResult {
  Image image;  ///< R G B A, diffuse, specular, albedo, N, P, Z, irradiance; linear Rec.709, radiance W/(mm^2
                ///< sr)
  std::vector<std::uint8_t> translucent;  ///< per pixel: 1 if most of its covered part is translucent
  std::size_t queries = 0;                ///< points with evaluated exitance
  std::size_t non_finite = 0;             ///< pixels of non-finite radiance; 0 unless something is broken
};

/// Radiance towards the camera.
/// `hierarchical`: translucent surfaces emit M_o Ft(omega_o) / (pi (1 - F_bar)) with M_o from the trees;
/// `lambert`: the same with M_o = total diffuse reflectance x E at the point itself, the limit of a vanishing
/// mean free path and the cheapest method. Both add the specular reflection of area lights and environments,
/// weight F. Opaque surfaces are Lambertian. Lights illuminate all surfaces; with settings.bounces, surfaces
/// illuminate each other once.
RenderResult render(const RenderInput& input);

/// For RenderInput::bounced, given the other inputs.
std::shared_ptr<const BouncedPlaces> bounced_places(const RenderInput& input);

/// Mean over the lit pixels of the estimated |error| / max(diffuse, 1e-3 of its p99) from the `error` layer,
/// worst channel; 0 without that layer.
/// in    counted: mask of pixels as in RenderResult::translucent; empty or all 0: all pixels
/// out   within a factor 2 of the measured mean in most scenes at most settings (bench_error_estimate)
double estimated_relative_error(const Image& image, std::span<const std::uint8_t> counted = {});

}  // namespace opaline
