// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/cut_cube.h"

#include <algorithm>
#include <cmath>

namespace opaline {
namespace {

constexpr double kLeast = .001;  // minimum component of a normal; it is a divisor, three times

}  // namespace

// Simplex cut off the lowest corner by the plane, minus those outside the cube.
PartOfCube part_behind(const Vec3d& normal, double height) {
  std::array<double, 3> m{};
  for (std::size_t axis = 0; axis < 3; ++axis) m[axis] = std::max(kLeast, std::abs(normal[axis]));
  const double from_corner = height + .5 * (m[0] + m[1] + m[2]);
  PartOfCube part;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3d at(-.5, -.5, -.5);
    double over = from_corner, sign = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((corner >> axis & 1) != 0) {
        at[axis] = .5;
        over -= m[axis];
        sign = -sign;
      }
    if (!(over > 0)) continue;
    const double volume = sign * over * over * over / (6 * m[0] * m[1] * m[2]);
    part.volume += volume;
    part.centre += (at + Vec3d(1 / m[0], 1 / m[1], 1 / m[2]) * (over / 4)) * volume;
  }
  if (!(part.volume > 0)) return {};
  for (std::size_t axis = 0; axis < 3; ++axis)
    part.centre[axis] =
        std::copysign(1., normal[axis]) * std::clamp(part.centre[axis] / part.volume, -.5, .5);
  part.volume = std::min(part.volume, 1.);
  return part;
}

double share_behind(const std::array<double, 2>& normal, double height) {
  const double a = std::max(kLeast, std::abs(normal[0])), b = std::max(kLeast, std::abs(normal[1]));
  const auto squared = [](double over) { return over > 0 ? over * over : 0; };
  const double over = height + .5 * (a + b);
  return std::clamp(
      (squared(over) - squared(over - a) - squared(over - b) + squared(over - a - b)) / (2 * a * b), 0., 1.);
}

}  // namespace opaline
