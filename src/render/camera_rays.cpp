// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/camera_rays.h"

#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace opaline {
namespace {

// The inverse of the filter's cumulative distribution along one axis, u in [0, 1).
double filter_place(PixelFilter filter, double u) {
  if (filter == PixelFilter::box) return u - 0.5;
  constexpr double kSigma = 0.5, kRadius = 1.5;
  const double edge = boost::math::erf(kRadius / (kSigma * std::numbers::sqrt2));
  return kSigma * std::numbers::sqrt2 * boost::math::erf_inv(edge * (2 * u - 1));
}

}  // namespace

double pixel_width(const Camera& camera, const Film& film) {
  return 2 * std::tan(camera.field_of_view * std::numbers::pi / 360) / film.resolution[1];
}

CameraRays::CameraRays(const Camera& camera, const Film& film, const World& world)
    : position_(into_world(world, camera.position)),
      forward_(normalized(camera.look_at - camera.position)),
      center_x_(0.5 * film.resolution[0]),
      center_y_(0.5 * film.resolution[1]) {
  const double pixel = pixel_width(camera, film);
  const Vec3d right = normalized(cross(forward_, camera.up));
  right_ = right * pixel;
  down_ = cross(forward_, right) * pixel;
  across_ = right / pixel;
  below_ = cross(forward_, right) / pixel;
  for (int i = 0; i < film.samples_per_pixel; ++i) {
    const auto [u, v] = r2_point(std::uint64_t(i), {0.5, 0.5});
    places_.push_back({filter_place(film.filter, u), filter_place(film.filter, v)});
  }
}

Ray CameraRays::ray(int x, int y, int sample) const {
  const Place& place = places_[std::size_t(sample)];
  const double across = x + 0.5 + place.x - center_x_, below = y + 0.5 + place.y - center_y_;
  return {Vec3f(position_), Vec3f(forward_ + right_ * across + down_ * below)};
}

CameraRays::FilmPlace CameraRays::film_place(const Vec3d& point) const {
  const Vec3d towards = point - position_;
  const double depth = dot(towards, forward_), per_depth = 1 / depth;
  return {center_x_ + dot(towards, across_) * per_depth, center_y_ + dot(towards, below_) * per_depth, depth};
}

}  // namespace opaline
