// SPDX-License-Identifier: GPL-3.0-or-later
// Rendering of an image from a prepared scene.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "opaline/image.h"
#include "opaline/session.h"
#include "subsurface/held_view.h"
#include "subsurface/render_input.h"

namespace opaline {

/// Pixels [x0, x1) x [y0, y1) of the full image.
struct Rectangle {
  int x0, y0, x1, y1;
};

/// Rendered rectangle: the crop of the film, or the whole film.
Rectangle rendered_part(const Film& film);

/// Maximum size of a cached view, bytes.
inline constexpr std::size_t kMostHeldBytes = std::size_t(256) << 20;
inline constexpr std::size_t kMostCoatBytes = std::size_t(256) << 20;  ///< in addition, for HeldView::Coat

/// Memory of the view cached between frames, bytes; without reflections and gathered hits. 0: larger than kMostHeldBytes,
/// not cached
/// in    lights: number of lights; seen: pixels with a hit
std::size_t held_view_bytes(const Film& film, std::size_t lights, std::size_t seen);

/// Radiance towards the camera.
/// `hierarchical`: translucent surfaces emit M_o Ft(omega_o) / (pi (1 - F_bar)) with M_o from the trees;
/// `lambert`: the same with M_o = total diffuse reflectance x E at the point itself, the limit of a vanishing
/// mean free path and the cheapest method. Both add the specular reflection of area lights and environments,
/// weight F. Opaque surfaces are Lambertian. Lights illuminate all surfaces; with settings.bounces, surfaces
/// illuminate each other once.
RenderResult render(const RenderInput& input);

/// For RenderInput::bounced, given the other inputs.
std::shared_ptr<const BouncedPlaces> bounced_places(const RenderInput& input);

}  // namespace opaline
