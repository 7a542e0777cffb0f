// SPDX-License-Identifier: GPL-3.0-or-later
// From pixels to rays.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"
#include "opaline/scene.h"

namespace opaline {

/// Height of a pixel by depth, world units.
struct PixelWidth {
  double at_camera = 0, per_depth = 0;
  double at(double depth) const { return at_camera + per_depth * depth; }
};
PixelWidth pixel_width(const Camera& camera, const Film& film, const World& world);

/// Rays through the film. Directions have length 1 along the view axis, so a ray's time is the depth Z. All
/// pixels share one pattern of sub-pixel positions, sampled from the reconstruction filter; their mean is the
/// centre. Positions on a lens differ from pixel to pixel.
class CameraRays {
 public:
  CameraRays(const Camera& camera, const Film& film, const World& world);
  /// With the shutter of the scene: rays have times from 0 to 1, and the camera moves.
  CameraRays(const Scene& scene, const World& world);

  /// Replaces the samples of each pixel by an endless random sequence of its own. Its first 2^k samples, and the 2^k
  /// after them, cover pixel, lens and exposure evenly.
  void make_progressive(std::uint64_t seed);

  /// x, y: pixel in the full image; sample in [0, samples_per_pixel), or any if progressive.
  Ray ray(int x, int y, int sample) const;
  /// From the middle of the lens through the middle of a pixel.
  Ray middle_ray(int x, int y) const;

  /// Projection of a world point from the middle of the lens: pixels from the top left of the image, and the
  /// depth Z. Behind the camera (Z <= 0), x and y are meaningless.
  struct FilmPlace {
    double x, y, depth;
  };
  FilmPlace film_place(const Vec3d& point) const;

  /// Radius of the image of a point at this depth, pixels: 0 in focus.
  double blur_radius(double depth) const;

 private:
  struct Place {
    double x, y;
  };
  Ray ray_through(double across, double below) const;
  /// The same of a still camera.
  Ray still_ray(int x, int y, int sample) const;
  Place pixel_place(int x, int y, int sample) const;
  Place lens_place(int x, int y, int sample) const;
  double time(int x, int y, int sample) const;
  /// Point of the progressive sequence; dimension: of several independent ones.
  std::array<double, 2> progressive_point(std::uint64_t dimension, int x, int y, int sample) const;
  std::uint64_t number_of(int x, int y) const { return std::uint64_t(y) * row_pixels_ + std::uint64_t(x); }

  Vec3d position_, forward_, right_, down_;  // right_ and down_: one pixel on the film plane at depth 1
  Vec3d across_, below_;                     // dot products with them, over the depth, are pixels
  double center_x_, center_y_;
  PixelWidth width_;
  bool is_parallel_;
  std::uint64_t row_pixels_;
  Vec3d lens_right_, lens_down_;  // radius of the lens
  double lens_radius_, per_focus_distance_;
  int blades_;
  PixelFilter filter_;
  std::vector<Place> places_;                 // relative to the pixel's centre
  std::optional<std::uint64_t> progressive_;  // seed
  std::vector<double> filter_places_;  // progressive: inverse of the filter's distribution, at equal steps
  bool has_shutter_ = false;
  std::vector<CameraRays> poses_;  // while the shutter is open; empty: the camera stays
};

/// First hits of camera rays: rays pass through shapes hidden from the camera.
void intersect_from_camera(const Scene& scene, const RayScene& scene_rays, std::span<TracedRay> rays);

}  // namespace opaline
