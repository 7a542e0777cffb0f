// SPDX-License-Identifier: GPL-3.0-or-later
// From pixels to rays.
#pragma once

#include <vector>

#include "geometry/ray_scene.h"
#include "opaline/scene.h"

namespace opaline {

/// Width of a pixel at depth 1.
double pixel_width(const Camera& camera, const Film& film);

/// Rays through the film. Directions have length 1 along the view axis, so a ray's time is the depth Z. All
/// pixels share one pattern of sub-pixel positions, sampled from the reconstruction filter; a single sample
/// is at the centre.
class CameraRays {
 public:
  CameraRays(const Camera& camera, const Film& film, const World& world);

  /// x, y: pixel in the full image; sample in [0, samples_per_pixel).
  Ray ray(int x, int y, int sample) const;

  /// Projection of a world point: pixels from the top left of the image, and the depth Z. Behind the camera
  /// (Z <= 0), x and y are meaningless.
  struct FilmPlace {
    double x, y, depth;
  };
  FilmPlace film_place(const Vec3d& point) const;

 private:
  Vec3d position_, forward_, right_, down_;  // right_ and down_: one pixel on the film plane at depth 1
  Vec3d across_, below_;                     // dot products with them, over the depth, are pixels
  double center_x_, center_y_;
  struct Place {
    double x, y;
  };
  std::vector<Place> places_;  // relative to the pixel's centre
};

}  // namespace opaline
