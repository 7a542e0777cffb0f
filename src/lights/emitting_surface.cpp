// SPDX-License-Identifier: GPL-3.0-or-later
#include "lights/emitting_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"

namespace opaline {
namespace {

constexpr double kFewestCells = 4096;  // on a surface with a texture
constexpr double kEvenPart =
    .1;  // part of the samples spread by area alone, for dark texels beside bright ones

/// Cells of a triangle divided in rows parallel to its first side: `upper` ones point the other way.
struct Cell {
  int row, column;
  bool is_upper;
};

int index_of(const Cell& cell, int divisions) {
  return (2 * divisions - cell.row) * cell.row + 2 * cell.column + (cell.is_upper ? 1 : 0);
}

Cell cell_at(int index, int divisions) {
  int row = 0;
  while (row + 1 < divisions && index_of({row + 1, 0, false}, divisions) <= index) ++row;
  const int along = index - index_of({row, 0, false}, divisions);
  return {row, along / 2, along % 2 == 1};
}

/// Barycentrics of a point of a cell; a and b: uniform in [0, 1).
std::array<float, 2> in_cell(const Cell& cell, int divisions, double a, double b) {
  if (a + b > 1) a = 1 - a, b = 1 - b;
  const double u = cell.is_upper ? cell.column + 1 - a : cell.column + a,
               v = cell.is_upper ? cell.row + 1 - b : cell.row + b;
  return {float(u / divisions), float(v / divisions)};
}

float mean(const RgbF& color) {
  return (color.x + color.y + color.z) / 3;
}

}  // namespace

EmittingSurface::EmittingSurface(World world, Texels texels, std::uint64_t hash, float clearance)
    : world_(std::move(world)),
      texels_(std::move(texels)),
      hash_(hash),
      clearance_(clearance),
      box_(bounds(world_.meshes[0])) {
  const Mesh& mesh = world_.meshes[0];
  for (const Vec3d& position : mesh.positions) radius_ = std::max(radius_, length(position - center()));
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d corner = mesh.positions[a], u = mesh.positions[b] - corner, v = mesh.positions[c] - corner;
    faces_.push_back({Vec3f(corner), Vec3f(u), Vec3f(v), .5 * length(cross(u, v)), 0, 1});
    area_ += faces_.back().area;
  }
  std::size_t cells = 0;
  for (Face& face : faces_) {
    if (texels_) face.divisions = std::max(1, int(std::sqrt(kFewestCells * face.area / area_)));
    face.first_cell = cells;
    cells += std::size_t(face.divisions) * std::size_t(face.divisions);
  }
  face_of_cell_.resize(cells);
  ends_.resize(cells);
  parallel_chunks(faces_.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t f = begin; f < end; ++f) {
      const Face& face = faces_[f];
      const int count = face.divisions * face.divisions;
      const float side = 1 / float(face.divisions);
      for (int c = 0; c < count; ++c) {
        const auto [u, v] = in_cell(cell_at(c, face.divisions), face.divisions, 1. / 3, 1. / 3);
        const std::array<Vec3f, 2> sides{face.u * side, face.v * side};
        face_of_cell_[face.first_cell + std::size_t(c)] = std::uint32_t(f);
        ends_[face.first_cell + std::size_t(c)] =
            face.area / count * double(mean(texel(point_of(std::uint32_t(f), u, v), sides)));
      }
    }
  });
  double flux = 0;
  for (const double of_cell : ends_) flux += of_cell;
  double sum = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    const Face& face = faces_[face_of_cell_[c]];
    const double even = face.area / (area_ * face.divisions * face.divisions);
    sum += flux > 0 ? (1 - kEvenPart) * ends_[c] / flux + kEvenPart * even : even;
    ends_[c] = sum;
  }
  for (double& end : ends_) end /= sum;
}

EmittingSurface::Point EmittingSurface::point_of(std::uint32_t triangle, float u, float v) const {
  const Face& face = faces_[triangle];
  return {triangle, u, v, face.corner + face.u * u + face.v * v, normalized(cross(face.u, face.v))};
}

EmittingSurface::Point EmittingSurface::sample(std::array<double, 2> unit_square) const {
  const auto found = std::ranges::upper_bound(ends_, unit_square[0]);
  const std::size_t cell = std::min(std::size_t(found - ends_.begin()), ends_.size() - 1);
  const double begin = cell > 0 ? ends_[cell - 1] : 0, width = ends_[cell] - begin;
  const double rest = width > 0 ? std::clamp((unit_square[0] - begin) / width, 0., 1.) : .5;
  const std::uint32_t triangle = face_of_cell_[cell];
  const Face& face = faces_[triangle];
  const auto [u, v] =
      in_cell(cell_at(int(cell - face.first_cell), face.divisions), face.divisions, rest, unit_square[1]);
  Point point = point_of(triangle, u, v);
  point.density = density_in(cell);
  return point;
}

std::size_t EmittingSurface::cell_of(const Point& point) const {
  const Face& face = faces_[point.triangle];
  const int n = face.divisions;
  const float u = std::max(0.f, point.u) * float(n), v = std::max(0.f, point.v) * float(n);
  const int row = std::min(int(v), n - 1), column = std::min(int(u), n - 1 - row);
  const bool is_upper = (u - float(column)) + (v - float(row)) > 1 && column < n - 1 - row;
  return face.first_cell + std::size_t(index_of({row, column, is_upper}, n));
}

double EmittingSurface::density_in(std::size_t cell) const {
  const Face& face = faces_[face_of_cell_[cell]];
  const double fraction = ends_[cell] - (cell > 0 ? ends_[cell - 1] : 0);
  return fraction * face.divisions * face.divisions / face.area;
}

std::optional<EmittingSurface::Point> EmittingSurface::first_met(const Vec3f& origin, const Vec3f& direction,
                                                                 float near, float& far) const {
  std::call_once(has_rays_, [&] { rays_ = std::make_unique<const RayScene>(world_); });
  TracedRay traced{Ray(origin, direction, far), {}};
  traced.ray.near = near;
  rays_->intersect_one(traced);
  if (traced.hit.mesh == Hit::kMiss) return {};
  Point met = point_of(traced.hit.triangle, traced.hit.u, traced.hit.v);
  if (!(dot(met.normal, direction) < 0)) return {};
  met.density = density_in(cell_of(met));
  far = traced.ray.far;
  return met;
}

RgbF EmittingSurface::texel(const Point& point, const std::array<Vec3f, 2>& sides) const {
  return texels_ ? texels_(world_, point.triangle, point.u, point.v, sides) : RgbF(1);
}

}  // namespace opaline
