// SPDX-License-Identifier: GPL-3.0-or-later
// Emitting triangles: importance sampling of their points, and rays towards them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"
#include "geometry/world.h"

namespace opaline {

/// The surface of a shape emitting on its outer side. Cells, parts of triangles of about one size, are sampled by
/// their flux: area times mean texel. Points are uniform in a cell.
class EmittingSurface {
 public:
  /// Factor of the radiance at a point of a triangle, filtered over a parallelogram around it.
  /// in    u, v: barycentrics of the second and third corner; sides: of the parallelogram, world units
  using Texels = std::function<RgbF(const World& world, std::uint32_t triangle, float u, float v,
                                    const std::array<Vec3f, 2>& sides)>;

  /// in    world: of one mesh; texels: empty for a constant; hash: of all of these; clearance: distance from the
  ///       surface at which shadow rays end, world units
  EmittingSurface(World world, Texels texels, std::uint64_t hash, float clearance);

  struct Point {
    std::uint32_t triangle = 0;
    float u = 0, v = 0;
    Vec3f position{}, normal{};  ///< normal: unit, of the triangle
    double density = 0;          ///< density of the samples, per area
  };
  Point sample(std::array<double, 2> unit_square) const;

  /// First point of the surface on a ray between `near` and `far`, if seen from outside.
  /// out   far: its distance
  std::optional<Point> first_met(const Vec3f& origin, const Vec3f& direction, float near, float& far) const;

  RgbF texel(const Point& point, const std::array<Vec3f, 2>& sides = {}) const;
  float clearance() const { return clearance_; }
  std::uint64_t hash() const { return hash_; }
  const Bounds& box() const { return box_; }
  double area() const { return area_; }
  /// Bounding sphere around the middle of the box.
  Vec3d center() const { return .5 * (box_.low + box_.high); }
  double radius() const { return radius_; }
  /// True without a texture, if rays through the bounding sphere mostly meet the surface.
  bool is_round() const {
    constexpr double kLeastFilled = .5;
    return !texels_ && .25 * area_ > kLeastFilled * std::numbers::pi * radius_ * radius_;
  }

 private:
  Point point_of(std::uint32_t triangle, float u, float v) const;
  std::size_t cell_of(const Point& point) const;
  double density_in(std::size_t cell) const;

  World world_;
  Texels texels_;
  std::uint64_t hash_;
  float clearance_;
  double area_ = 0, radius_ = 0;
  Bounds box_;
  struct Face {
    Vec3f corner, u, v;
    double area;
    std::size_t first_cell;
    int divisions;  // parts of each side: their square is the number of cells
  };
  std::vector<Face> faces_;
  std::vector<std::uint32_t> face_of_cell_;
  std::vector<double> ends_;  // cumulative fractions of the cells' flux
  mutable std::once_flag has_rays_;
  mutable std::unique_ptr<const RayScene> rays_;
};

}  // namespace opaline
