// SPDX-License-Identifier: GPL-3.0-or-later
// Views from lights: the points of a body reached by each light, where it enters.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bodies/body.h"
#include "exitance/octree.h"
#include "geometry/ray_scene.h"
#include "geometry/world.h"
#include "lights/light.h"

namespace opaline {

/// Most pixels of a view, about; a box around a sparse body may need more at the spacing.
inline constexpr std::size_t kMostPixelsOfView = 1 << 20;

/// Flux transmitted at the pixels of views from all lights, with area = distance^2 x solid angle / cosine.
/// One view for a light without an area; several from points on it or, for an environment, directions of it.
/// in    input: scene, world and rays; spacing: of the points of one light, world units
/// out   samples in the body's surface, unordered; empty where no light arrives
std::vector<FluxSample> seen_from_lights(const PrecomputeInput& input, const Body& body, double spacing);

/// Rays through the pixels of a view towards a box, and the solid angle of each, or the area across parallel
/// ones.
struct LightView {
  std::vector<Ray> rays;
  std::vector<float> measures;
  bool is_parallel = false;

  /// A rectangle of pixels, row by row.
  struct Plane {
    std::size_t first, columns, rows;  // indices of rays
    Vec3f x, y;                        // sides of a pixel; perspective: at distance 1
    Vec3f forward;                     // perspective
  };
  std::vector<Plane> planes;

  /// A ray through a pixel beside its middle.
  /// in    u, v: from -1/2 to 1/2, in sides of the pixel
  Ray ray(const Plane& plane, std::size_t pixel, float u, float v) const;
};

/// Parallel rays from outside of the scene.
/// in    towards: unit, to the light; reach: diagonal of the scene; spacing: of the pixels, world units; shift: of
///       their lattice, in pixels
LightView parallel_view(const Bounds& box, const Vec3d& towards, double reach, double spacing,
                        std::array<double, 2> shift = {});
/// Rays from a point, through a plane behind which the box lies, or through six around the point.
/// in    spacing: of the pixels at the box's centre
LightView view_from(const Bounds& box, const Vec3d& position, double spacing,
                    std::array<double, 2> shift = {});

}  // namespace opaline
