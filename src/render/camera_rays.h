// SPDX-License-Identifier: GPL-3.0-or-later
// From pixels to rays.
#pragma once

#include <vector>

#include "geometry/ray_scene.h"
#include "opaline/scene.h"

namespace opaline {

/// Width of a pixel at depth 1.
double pixel_width(const Camera& camera, const Film& film);

/// Rays through the film. Directions have length 1 along the view axis: a ray's time is the depth Z. All
/// pixels share one pattern of sub-pixel places, drawn from the filter's density; a single sample is the
/// centre.
class CameraRays {
 public:
  CameraRays(const Camera& camera, const Film& film, const World& world);

  /// x, y: pixel in the whole picture; sample in [0, samples_per_pixel).
  Ray ray(int x, int y, int sample) const;

  /// Where a point of the world is seen: pixels from the picture's top left, and the depth Z, <= 0 behind the
  /// camera, where x and y mean nothing.
  struct FilmPlace {
    double x, y, depth;
  };
  FilmPlace film_place(const Vec3d& point) const;

 private:
  Vec3d position_, forward_, right_, down_;  // right_ and down_: one pixel on the film plane at depth 1
  Vec3d across_, below_;                     // along them; times what is at depth 1: pixels
  double center_x_, center_y_;
  struct Place {
    double x, y;
  };
  std::vector<Place> places_;  // relative to the pixel's centre
};

}  // namespace opaline
