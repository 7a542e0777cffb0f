// SPDX-License-Identifier: GPL-3.0-or-later
// Medium at a depth below a surface of layers.
#pragma once

#include <array>
#include <cstddef>

#include "bodies/surface_textures.h"
#include "diffusion/reduced_medium.h"
#include "geometry/nearest_surface.h"

namespace opaline {

/// Centre of a cube cut by the surface: its own, or the centre of its part inside the body.
enum class CubeCentre { own, inside };

/// Media of R G B from coefficients in 1/mm, lengths in a unit of so many mm; empty ones scatter almost nothing.
std::array<ReducedMedium, 3> reduced_media(const PhysicalMedium& medium, double eta, double unit);

/// Layers of a medium below the surface of its bodies; R G B, reduced, lengths in the world's unit.
class LayeredMedia {
 public:
  /// medium: with layers. Scene and world must outlive the object.
  LayeredMedia(const Scene& scene, const World& world, const Medium& medium, CubeCentre centre);

  /// Mean of the layers over the depths of a cube: absorption by volume, and diffusion harmonically, so thinner
  /// layers than the cube keep their optical thickness.
  /// in    nearest: surface point nearest to the cube's centre; width: edge of the cube, world units
  std::array<ReducedMedium, 3> at(const Vec3d& position, const NearestSurface::Place& nearest,
                                  float width) const;

 private:
  const World& world_;
  const Medium& medium_;
  CubeCentre centre_;
  SurfaceTextures textures_;
};

}  // namespace opaline
