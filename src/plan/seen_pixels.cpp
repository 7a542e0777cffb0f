// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/seen_pixels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "lights/light.h"
#include "lights/light_kind.h"
#include "lights/light_tree.h"
#include "render/camera_rays.h"
#include "render/render.h"

namespace opaline {
namespace {

constexpr int kCells = 64;      // along each side, at most
constexpr int kNarrowest = 16;  // pixels of a cell
constexpr double kApart = 3;    // pixels around a triangle: the filter's radius, and rounding

/// Cells around a position in the image, as x0, -x1, y0, -y1, so the union of two boxes is a minimum. Outside
/// the part, a coordinate is -1 or the number of cells.
typedef short CellBox __attribute__((vector_size(8)));
CellBox around_both(const CellBox& a, const CellBox& b) {
  return a < b ? a : b;
}

class SeenCells {
 public:
  explicit SeenCells(const Rectangle& part)
      : part_(part),
        columns_(count(part.x1 - part.x0)),
        rows_(count(part.y1 - part.y0)),
        across_(double(columns_) / (part.x1 - part.x0)),
        down_(double(rows_) / (part.y1 - part.y0)) {}

  /// blur: radius, pixels
  CellBox around(const CameraRays::FilmPlace& place, double blur) const {
    // Truncates a value >= 0; without SSE 4.1, std::floor is a function call.
    const auto cell = [](double at, int cells) {
      return short(short(std::clamp(at + 1, 0.0, double(cells + 1))) - 1);
    };
    const double x = (place.x - part_.x0) * across_, y = (place.y - part_.y0) * down_;
    const double beside = (kApart + blur) * across_, below = (kApart + blur) * down_;
    return CellBox{cell(x - beside, columns_), short(-cell(x + beside, columns_)), cell(y - below, rows_),
                   short(-cell(y + below, rows_))};
  }

  void add(const CellBox& box) {
    const int x0 = std::max<int>(0, box[0]), x1 = std::min(columns_ - 1, -box[1]),
              y0 = std::max<int>(0, box[2]), y1 = std::min(rows_ - 1, -box[3]);
    if (x0 > x1) return;
    const std::uint64_t columns = ~0ull >> (kCells - 1 - x1) & ~0ull << x0;
    for (int y = y0; y <= y1; ++y) seen_[std::size_t(y)] |= columns;
  }

  double share() const {
    int seen = 0;
    for (const std::uint64_t row : seen_) seen += std::popcount(row);
    return seen / (double(columns_) * rows_);
  }

 private:
  static int count(int side) { return std::clamp(side / kNarrowest, 1, kCells); }

  Rectangle part_;
  int columns_, rows_;
  double across_, down_;                      // cells of a pixel
  std::array<std::uint64_t, kCells> seen_{};  // row by row, a bit a column
};

/// Returns false if a light may be visible anywhere.
bool add_light(const Light& light, const CameraRays& rays, SeenCells& cells) {
  if (const auto* many = std::get_if<ManyLights>(&light.source))
    return std::ranges::all_of(many->tree->lights(), [&](const Light& one) {
      return !is_visible(one) || add_light(one, rays, cells);
    });
  const std::optional<Lamp> lamp = lamp_of(light);
  if (!lamp) return false;
  CellBox around{kCells, kCells, kCells, kCells};
  for (int corner = 0; corner < 8; ++corner) {
    const auto side = [&](int axis) { return corner >> axis & 1 ? lamp->radius : -lamp->radius; };
    const CameraRays::FilmPlace place = rays.film_place(lamp->center + Vec3d{side(0), side(1), side(2)});
    if (!(place.depth > 0)) return false;
    around = around_both(around, cells.around(place, rays.blur_radius(place.depth)));
  }
  cells.add(around);
  return true;
}

}  // namespace

std::size_t seen_pixels(const Scene& scene, std::span<const Light> lights, const World& world) {
  const Rectangle part = rendered_part(scene.film);
  const std::size_t all = std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0);
  if (scene.backdrop) return all;
  const CameraRays rays(scene.camera, scene.film, world);
  SeenCells cells(part);
  for (const Light& light : lights)
    if (light.is_seen && is_visible(light) && !is_of_shape(light) && !add_light(light, rays, cells))
      return all;
  std::vector<CellBox> around;  // each vertex
  for (const Mesh& mesh : world.meshes) {
    around.clear();
    for (const Vec3d& position : mesh.positions) {
      const CameraRays::FilmPlace place = rays.film_place(position);
      if (!(place.depth > 0)) return all;
      around.push_back(cells.around(place, rays.blur_radius(place.depth)));
    }
    for (const auto& [a, b, c] : mesh.triangles)
      cells.add(around_both(around_both(around[a], around[b]), around[c]));
  }
  return std::size_t(std::ceil(cells.share() * double(all)));
}

}  // namespace opaline
