// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/seen_pixels.h"

#include <algorithm>
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

/// The cells around a place of the picture; outside of the part -1 or kCells.
struct CellBox {
  int x0, x1, y0, y1;
};

int cell(double at, int low, int high) {
  return int(std::clamp(std::floor((at - low) / (high - low) * kCells), -1.0, double(kCells)));
}

CellBox cells_around(const CameraRays::FilmPlace& place, const Rectangle& part) {
  return {cell(place.x - kApart, part.x0, part.x1), cell(place.x + kApart, part.x0, part.x1),
          cell(place.y - kApart, part.y0, part.y1), cell(place.y + kApart, part.y0, part.y1)};
}

class SeenCells {
 public:
  void add(const CellBox& a, const CellBox& b, const CellBox& c) {
    const int x0 = std::max(0, std::min({a.x0, b.x0, c.x0})), x1 = std::min(kCells - 1, std::max({a.x1, b.x1, c.x1})),
              y0 = std::max(0, std::min({a.y0, b.y0, c.y0})), y1 = std::min(kCells - 1, std::max({a.y1, b.y1, c.y1}));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) seen_[std::size_t(y * kCells + x)] = true;
  }

  double share() const { return double(seen_.count()) / (kCells * kCells); }

 private:
  std::bitset<std::size_t(kCells* kCells)> seen_;
};

}  // namespace

std::size_t seen_pixels(const Scene& scene, const World& world) {
  const Rectangle part = rendered_part(scene.film);
  const std::size_t all = std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0);
  if (std::ranges::any_of(scene.lights, [](const Light& light) { return !is_delta(light); })) return all;
  const CameraRays rays(scene.camera, scene.film, world);
  SeenCells cells;
  std::vector<CellBox> around;  // each vertex
  for (const Mesh& mesh : world.meshes) {
    around.clear();
    for (const Vec3d& position : mesh.positions) {
      const CameraRays::FilmPlace place = rays.film_place(position);
      if (!(place.depth > 0)) return all;
      around.push_back(cells_around(place, part));
    }
    for (const auto& [a, b, c] : mesh.triangles) cells.add(around[a], around[b], around[c]);
  }
  return std::size_t(std::ceil(cells.share() * double(all)));
}

}  // namespace opaline
