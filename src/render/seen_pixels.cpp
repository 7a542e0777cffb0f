// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/seen_pixels.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <vector>

#include "opaline/lights/light.h"
#include "opaline/render/render.h"
#include "render/camera_rays.h"

namespace opaline {
namespace {

constexpr int kCells = 64;      // along each side, at most
constexpr int kNarrowest = 16;  // pixels of a cell
constexpr double kApart = 3;    // pixels around a triangle: the filter's radius, and rounding

/// The cells around a place of the picture; outside of the part -1 or their number.
struct CellBox {
  int x0, x1, y0, y1;
};

class SeenCells {
 public:
  explicit SeenCells(const Rectangle& part)
      : part_(part), columns_(count(part.x1 - part.x0)), rows_(count(part.y1 - part.y0)) {}

  CellBox around(const CameraRays::FilmPlace& place) const {
    // Truncation of what is not negative: std::floor is a call without SSE 4.1.
    const auto cell = [](double at, int low, int high, int cells) {
      return int(std::clamp((at - low) / (high - low) * cells + 1, 0.0, double(cells + 1))) - 1;
    };
    return {cell(place.x - kApart, part_.x0, part_.x1, columns_),
            cell(place.x + kApart, part_.x0, part_.x1, columns_),
            cell(place.y - kApart, part_.y0, part_.y1, rows_),
            cell(place.y + kApart, part_.y0, part_.y1, rows_)};
  }

  void add(const CellBox& a, const CellBox& b, const CellBox& c) {
    const int x0 = std::max(0, std::min({a.x0, b.x0, c.x0})),
              x1 = std::min(columns_ - 1, std::max({a.x1, b.x1, c.x1})),
              y0 = std::max(0, std::min({a.y0, b.y0, c.y0})),
              y1 = std::min(rows_ - 1, std::max({a.y1, b.y1, c.y1}));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) seen_[std::size_t(y * kCells + x)] = true;
  }

  double share() const { return double(seen_.count()) / (double(columns_) * rows_); }

 private:
  static int count(int side) { return std::clamp(side / kNarrowest, 1, kCells); }

  Rectangle part_;
  int columns_, rows_;
  std::bitset<std::size_t(kCells* kCells)> seen_;
};

}  // namespace

std::size_t seen_pixels(const Scene& scene, const World& world) {
  const Rectangle part = rendered_part(scene.film);
  const std::size_t all = std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0);
  if (std::ranges::any_of(scene.lights, [](const Light& light) { return !is_delta(light); })) return all;
  const CameraRays rays(scene.camera, scene.film, world);
  SeenCells cells(part);
  std::vector<CellBox> around;  // each vertex
  for (const Mesh& mesh : world.meshes) {
    around.clear();
    for (const Vec3d& position : mesh.positions) {
      const CameraRays::FilmPlace place = rays.film_place(position);
      if (!(place.depth > 0)) return all;
      around.push_back(cells.around(place));
    }
    for (const auto& [a, b, c] : mesh.triangles) cells.add(around[a], around[b], around[c]);
  }
  return std::size_t(std::ceil(cells.share() * double(all)));
}

}  // namespace opaline
