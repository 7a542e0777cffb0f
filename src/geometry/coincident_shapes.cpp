// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/coincident_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geometry/nearest_on_triangle.h"

namespace opaline {
namespace {

constexpr double kRounding = 1e-6;  // fraction of a shape's diagonal
constexpr std::size_t kPoints = 16;

/// Bounds in integer steps of the rounding.
using BoundsKey = std::array<double, 6>;

BoundsKey key_of(const Bounds& box, double step) {
  BoundsKey key;
  for (std::size_t i = 0; i < 3; ++i) {
    key[i] = std::floor(box.low[i] / step);
    key[i + 3] = std::floor(box.high[i] / step);
  }
  return key;
}

bool is_on(const Vec3d& point, const Mesh& mesh, double reach) {
  return std::ranges::any_of(mesh.triangles, [&](const auto& t) {
    const std::array<Vec3d, 3> corners{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    return nearest_on(corners, point).square <= reach * reach;
  });
}

/// True if the middles of some triangles of one mesh lie on the other.
bool coincide(const Mesh& a, const Mesh& b, double reach) {
  const std::size_t step = std::max(a.triangles.size() / kPoints, std::size_t(1));
  for (std::size_t t = 0; t < a.triangles.size(); t += step) {
    Vec3d middle;
    for (const std::uint32_t v : a.triangles[t]) middle += a.positions[v] / 3.;
    if (!is_on(middle, b, reach)) return false;
  }
  return true;
}

}  // namespace

std::vector<std::string> warnings_of_coincident_shapes(const Scene& scene, const World& world) {
  constexpr std::size_t kMostNamed = 3;
  std::map<BoundsKey, std::vector<std::size_t>> by_bounds;  // first of several coincident shapes
  std::vector<std::string> warnings;
  std::size_t more = 0;
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    const Bounds& box = world.boxes[i];
    const double diagonal = length(box.high - box.low);
    if (!(diagonal > 0)) continue;
    const double step = kRounding * std::exp2(std::ilogb(diagonal)), reach = step / world.unit;
    std::vector<std::size_t>& others = by_bounds[key_of(box, step)];
    const auto same = std::ranges::find_if(others, [&](std::size_t other) {
      return coincide(world.meshes[i], world.meshes[other], reach) &&
             coincide(world.meshes[other], world.meshes[i], reach);
    });
    if (same == others.end())
      others.push_back(i);
    else if (warnings.size() == kMostNamed)
      ++more;
    else
      warnings.push_back(
          "the shapes '" + scene.shapes[*same].name + "' and '" + scene.shapes[i].name +
          "' have coincident surfaces, so rounding decides which one a ray hits; remove one of them");
  }
  if (more > 0) warnings.push_back(std::to_string(more) + " more shapes coincide with another shape");
  return warnings;
}

}  // namespace opaline
