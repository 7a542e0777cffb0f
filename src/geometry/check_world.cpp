// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/check_world.h"

#include <fmt/format.h>

#include <cmath>

#include "opaline/error.h"

namespace opaline {
namespace {

constexpr double kSmallestForItsPlace = 0x1p-16, kSmallestForTheWorld = 0x1p-30, kMostAreaLost = 0.1;

double twice_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return length(cross(b - a, c - a));
}

/// Area that rounding adds to or removes from all triangles, over their sum.
double area_lost(const Mesh& mesh) {
  double sum = 0, lost = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const double exact = twice_area(p, q, r);
    sum += exact;
    lost += std::abs(twice_area(Vec3d(Vec3f(p)), Vec3d(Vec3f(q)), Vec3d(Vec3f(r))) - exact);
  }
  return lost / sum;
}

}  // namespace

void check_precision(const Mesh& mesh, const std::string& name, double diagonal, double unit) {
  const Bounds box = bounds(mesh);
  const double side = max_component(box.high - box.low);
  const double far = max_component(component_max(box.high, -box.low));
  if (side < kSmallestForItsPlace * far)
    throw bad_file(name, "is too small for its distance from the centre of the scene",
                   fmt::format("at least {:.4g} mm (distance / 65536), the limit of single precision",
                               kSmallestForItsPlace * far * unit),
                   fmt::format("{:.4g} mm", side * unit));
  if (side < kSmallestForTheWorld * diagonal)
    throw bad_file(name, "is too small for the scene",
                   fmt::format("at least {:.4g} mm (diagonal of the scene / 2^30)",
                               kSmallestForTheWorld * diagonal * unit),
                   fmt::format("{:.4g} mm", side * unit));
  const double lost = area_lost(mesh);
  if (lost > kMostAreaLost)
    throw bad_file(name, "is too thin or too fine for its extent",
                   "vertices for which rounding to single precision (2^-24 times the distance from the "
                   "centre of the scene) changes the area by at most 10 %",
                   fmt::format("{:.3g} %", 100 * lost));
}

}  // namespace opaline
