// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/camera_rays.h"

#include <algorithm>
#include <array>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/random.h"
#include "core/scrambled_points.h"

namespace opaline {
namespace {

constexpr std::uint64_t kLensSeed = 0x6c656e73, kTimeSeed = 0x74696d65, kPixelSeed = 0x70697865;

// The inverse of the filter's cumulative distribution along one axis, u in [0, 1).
double filter_place(PixelFilter filter, double u) {
  if (filter == PixelFilter::box) return u - 0.5;
  constexpr double kSigma = 0.5, kRadius = 1.5;
  const double edge = boost::math::erf(kRadius / (kSigma * std::numbers::sqrt2));
  return kSigma * std::numbers::sqrt2 * boost::math::erf_inv(edge * (2 * u - 1));
}

using UnitPoints = std::vector<std::array<double, 2>>;

// Points with steps of 1/count to the right and `step`/count down, modulo 1.
UnitPoints lattice(int count, int step) {
  UnitPoints points;
  for (int i = 0; i < count; ++i)
    points.push_back({(i + .5) / count, (int(std::int64_t(i) * step % count) + .5) / count});
  return points;
}

// A grid whose columns lean one way and its rows the other, so that all x and all y differ.
UnitPoints leaning_grid(int columns, int rows) {
  UnitPoints points;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j)
      points.push_back({(i + (j + .5) / rows) / columns, (j + (columns - i - .5) / columns) / rows});
  return points;
}

// Between the closest points of a periodic pattern, from its first point; its other points have the same surroundings.
double least_distance2(const UnitPoints& points, std::size_t from) {
  double least = 2;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto side = [&](std::size_t d) {
      const double apart = std::abs(points[i][d] - points[from][d]);
      return std::min(apart, 1 - apart);
    };
    if (i != from) least = std::min(least, side(0) * side(0) + side(1) * side(1));
  }
  return least;
}

// The lattice or grid whose points are farthest apart; the mean of all is (.5, .5). For its errors at edges, see the test
// Camera.SamplesOfAPixelResolveEdges.
UnitPoints pixel_pattern(int count) {
  constexpr int kMostSearched = 256;
  constexpr double kGolden = .61803398874989485;
  if (count > kMostSearched) {
    int step = int(count * kGolden);
    while (std::gcd(step, count) > 1) ++step;
    return lattice(count, step);
  }
  int columns = int(std::sqrt(count));
  while (count % columns > 0) --columns;
  UnitPoints best = leaning_grid(columns, count / columns);
  double farthest = 0;
  for (std::size_t i = 0; i < best.size(); ++i) {
    const double least = least_distance2(best, i);
    farthest = i == 0 ? least : std::min(farthest, least);
  }
  for (int step = 1; step <= count / 2; ++step) {
    if (std::gcd(step, count) > 1) continue;
    UnitPoints other = lattice(count, step);
    const double least = least_distance2(other, 0);
    if (!(least > farthest * 1.001)) continue;  // a grid is better at equal distances
    best = std::move(other);
    farthest = least;
  }
  return best;
}

// Digits of i in this base, mirrored at the point.
double radical_inverse(std::uint64_t i, std::uint64_t base) {
  double place = 1, sum = 0;
  for (; i > 0; i /= base) sum += (place /= double(base)) * double(i % base);
  return sum;
}

double fraction(double value) {
  return value - std::floor(value);
}

}  // namespace

PixelWidth pixel_width(const Camera& camera, const Film& film, const World& world) {
  if (camera.orthographic_height) return {*camera.orthographic_height / world.unit / film.resolution[1], 0};
  return {0, 2 * std::tan(camera.field_of_view * std::numbers::pi / 360) / film.resolution[1]};
}

CameraRays::CameraRays(const Camera& camera, const Film& film, const World& world)
    : position_(into_world(world, camera.position)),
      forward_(normalized(camera.look_at - camera.position)),
      center_x_((0.5 - camera.shift[0]) * film.resolution[0]),
      center_y_((0.5 + camera.shift[1]) * film.resolution[1]),
      width_(pixel_width(camera, film, world)),
      is_parallel_(camera.orthographic_height.has_value()),
      row_pixels_(std::uint64_t(film.resolution[0])),
      lens_radius_(camera.aperture / 2 / world.unit),
      per_focus_distance_(world.unit /
                          camera.focus_distance.value_or(length(camera.look_at - camera.position))),
      blades_(camera.blades),
      filter_(film.filter) {
  const double pixel = width_.at(1), across = pixel * film.pixel_aspect;
  const Vec3d right = normalized(cross(forward_, camera.up)), down = cross(forward_, right);
  right_ = right * across;
  down_ = down * pixel;
  across_ = right / across;
  below_ = down / pixel;
  lens_right_ = right * lens_radius_;
  lens_down_ = down * lens_radius_;
  for (const auto& [u, v] : pixel_pattern(film.samples_per_pixel))
    places_.push_back({filter_place(film.filter, u), filter_place(film.filter, v)});
}

CameraRays::CameraRays(const Scene& scene, const World& world) : CameraRays(scene.camera, scene.film, world) {
  has_shutter_ = !scene.shutter.empty();
  const auto moves = [&](const ShutterPose& pose) { return !(pose.camera == scene.camera); };
  if (std::ranges::any_of(scene.shutter, moves))
    for (const ShutterPose& pose : scene.shutter) poses_.emplace_back(pose.camera, scene.film, world);
}

Ray CameraRays::ray_through(double across, double below) const {
  const Vec3d film = right_ * across + down_ * below;
  Ray ray = is_parallel_ ? Ray(Vec3f(position_ + film), Vec3f(forward_))
                         : Ray(Vec3f(position_), Vec3f(forward_ + film));
  ray.time = .5f;  // the middle of the exposure
  return ray;
}

void CameraRays::make_progressive(std::uint64_t seed) {
  constexpr int kSteps = 1024;
  progressive_ = seed;
  filter_places_.clear();
  for (int i = 0; i <= kSteps; ++i) filter_places_.push_back(filter_place(filter_, double(i) / kSteps));
  for (CameraRays& pose : poses_) pose.make_progressive(seed);
}

std::array<double, 2> CameraRays::progressive_point(std::uint64_t dimension, int x, int y, int sample) const {
  return scrambled_point(std::uint32_t(sample),
                         hash_bits(hash_bits(*progressive_, dimension), number_of(x, y)));
}

// Relative to the pixel's centre.
CameraRays::Place CameraRays::pixel_place(int x, int y, int sample) const {
  if (!progressive_) return places_[std::size_t(sample)];
  const auto [u, v] = progressive_point(kPixelSeed, x, y, sample);
  const auto place = [&](double at) {
    const double step = at * double(filter_places_.size() - 1), first = std::floor(step);
    const double* const places = filter_places_.data() + std::size_t(first);
    return places[0] + (step - first) * (places[1] - places[0]);
  };
  return {place(u), place(v)};
}

// In the unit disc, or the polygon of the blades inside it. Radical inverses are independent of the lattice of
// the pixel's positions; each pixel rotates them.
CameraRays::Place CameraRays::lens_place(int x, int y, int sample) const {
  const std::uint64_t bits = hash_bits(kLensSeed, number_of(x, y));
  const auto i = std::uint64_t(sample);
  double u = 0, v = 0;
  if (progressive_) {
    const std::array<double, 2> point = progressive_point(kLensSeed, x, y, sample);
    u = point[0];
    v = point[1];
  } else {
    u = fraction(radical_inverse(i, 2) + double(bits >> 32) * 0x1p-32);
    v = fraction(radical_inverse(i, 3) + double(bits & 0xffffffff) * 0x1p-32);
  }
  const double radius = std::sqrt(u), turn = 2 * std::numbers::pi;
  if (blades_ == 0) return {radius * std::cos(turn * v), radius * std::sin(turn * v)};
  const double side = std::floor(v * blades_), along = v * blades_ - side, corner = turn / blades_;
  const double a = corner * side, b = corner * (side + 1);
  return {radius * ((1 - along) * std::sin(a) + along * std::sin(b)),
          radius * ((along - 1) * std::cos(a) - along * std::cos(b))};
}

double CameraRays::time(int x, int y, int sample) const {
  constexpr std::uint64_t kTimeBase = 5;  // other than those of the lens
  if (progressive_) return progressive_point(kTimeSeed, x, y, sample)[0];
  const std::uint64_t bits = hash_bits(kTimeSeed, number_of(x, y));
  return fraction(radical_inverse(std::uint64_t(sample), kTimeBase) + double(bits >> 32) * 0x1p-32);
}

Ray CameraRays::ray(int x, int y, int sample) const {
  Ray ray = still_ray(x, y, sample);
  if (!has_shutter_) return ray;
  const double time = this->time(x, y, sample);
  if (!poses_.empty()) {
    const double step = time * double(poses_.size() - 1);
    const std::size_t i = std::size_t(step);
    const auto share = float(step - double(i));
    const Ray next = poses_[i + 1].still_ray(x, y, sample);
    ray = poses_[i].still_ray(x, y, sample);
    ray.origin = ray.origin * (1 - share) + next.origin * share;
    ray.direction = ray.direction * (1 - share) + next.direction * share;
  }
  ray.time = float(time);
  return ray;
}

Ray CameraRays::still_ray(int x, int y, int sample) const {
  const Place place = pixel_place(x, y, sample);
  Ray ray = ray_through(x + 0.5 + place.x - center_x_, y + 0.5 + place.y - center_y_);
  if (lens_radius_ == 0) return ray;
  const auto [right, down] = lens_place(x, y, sample);
  const Vec3d lens = lens_right_ * right + lens_down_ * down;
  ray.origin = Vec3f(Vec3d(ray.origin) + lens);
  ray.direction = Vec3f(Vec3d(ray.direction) - lens * per_focus_distance_);
  return ray;
}

Ray CameraRays::middle_ray(int x, int y) const {
  return ray_through(x + 0.5 - center_x_, y + 0.5 - center_y_);
}

CameraRays::FilmPlace CameraRays::film_place(const Vec3d& point) const {
  const Vec3d towards = point - position_;
  const double depth = dot(towards, forward_), per_depth = is_parallel_ ? 1 : 1 / depth;
  return {center_x_ + dot(towards, across_) * per_depth, center_y_ + dot(towards, below_) * per_depth, depth};
}

void intersect_from_camera(const Scene& scene, const RayScene& scene_rays, std::span<TracedRay> rays) {
  const RayScene& all = scene_rays.of_camera();
  all.intersect(rays);
  if (std::ranges::all_of(scene.shapes, &Shape::is_seen)) return;
  constexpr int kMostSurfaces = 1000;
  constexpr float kStep = 1e-6f;  // relative to the distance; the same surface may be met again
  std::vector<std::size_t> stopped;
  std::vector<TracedRay> further;
  for (int i = 0; i <= kMostSurfaces; ++i) {
    stopped.clear();
    further.clear();
    for (std::size_t r = 0; r < rays.size(); ++r) {
      const auto& [ray, hit] = rays[r];
      if (hit.mesh == Hit::kMiss || scene.shapes[hit.mesh].is_seen) continue;
      stopped.push_back(r);
      Ray next = ray;
      next.near = ray.far * (1 + kStep);
      next.far = std::numeric_limits<float>::infinity();
      further.push_back({next, {}});
    }
    if (stopped.empty()) return;
    if (i < kMostSurfaces) all.intersect(further);
    for (std::size_t k = 0; k < stopped.size(); ++k) rays[stopped[k]] = further[k];
  }
}

double CameraRays::blur_radius(double depth) const {
  return lens_radius_ == 0 ? 0 : lens_radius_ * std::abs(1 - depth * per_focus_distance_) / width_.at(depth);
}

}  // namespace opaline
