// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/seen_pixels.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <limits>
#include <vector>

#include "opaline/irradiance/light_sampling.h"
#include "opaline/render/render.h"
#include "render/camera_rays.h"

namespace opaline {
namespace {

constexpr int kCells = 64;    // along each side
constexpr double kApart = 3;  // pixels around a triangle: the filter's radius, and rounding

class SeenCells {
 public:
  explicit SeenCells(const Rectangle& part) : part_(part) {}

  /// The cells of the box around three places of the picture.
  void add(const std::array<CameraRays::FilmPlace, 3>& corners) {
    const auto [x0, x1] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
    const auto [y0, y1] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
    if (!(x1 + kApart > part_.x0 && x0 - kApart < part_.x1 && y1 + kApart > part_.y0 && y0 - kApart < part_.y1))
      return;
    for (int row = cell(y0 - kApart, part_.y0, part_.y1); row <= cell(y1 + kApart, part_.y0, part_.y1); ++row)
      for (int column = cell(x0 - kApart, part_.x0, part_.x1); column <= cell(x1 + kApart, part_.x0, part_.x1);
           ++column)
        seen_[std::size_t(row * kCells + column)] = true;
  }

  double share() const { return double(seen_.count()) / (kCells * kCells); }

 private:
  static int cell(double at, int low, int high) {
    return int(std::clamp(std::floor((at - low) / (high - low) * kCells), 0.0, kCells - 1.0));
  }

  Rectangle part_;
  std::bitset<std::size_t(kCells* kCells)> seen_;
};

}  // namespace

std::size_t seen_pixels(const Scene& scene, const World& world) {
  const Rectangle part = rendered_part(scene.film);
  const std::size_t all = std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0);
  if (std::ranges::any_of(scene.lights, [](const Light& light) { return !is_delta(light); })) return all;
  const CameraRays rays(scene.camera, scene.film, world);
  SeenCells cells(part);
  std::vector<CameraRays::FilmPlace> places;
  for (const Mesh& mesh : world.meshes) {
    places.clear();
    for (const Vec3d& position : mesh.positions) {
      places.push_back(rays.film_place(position));
      if (!(places.back().depth > 0)) return all;
    }
    for (const auto& [a, b, c] : mesh.triangles) cells.add({places[a], places[b], places[c]});
  }
  return std::size_t(std::ceil(cells.share() * double(all)));
}

}  // namespace opaline
