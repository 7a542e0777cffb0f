// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/inside_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/cancel_check.h"

namespace opaline {
namespace {

struct Crossing {
  std::uint32_t line;
  float z;
  bool enters;
};

// Twice the area of (a, b, p), from the lesser end of the edge in either order: two triangles sharing an edge
// agree on its points.
double side_of(const Vec3d& a, const Vec3d& b, double x, double y) {
  const bool swapped = b.x < a.x || (b.x == a.x && b.y < a.y);
  const Vec3d &from = swapped ? b : a, &to = swapped ? a : b;
  const double area = (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
  return swapped ? -area : area;
}

bool is_within(double side, const Vec3d& a, const Vec3d& b) {
  if (side != 0) return side > 0;
  return a.y != b.y ? a.y > b.y : a.x > b.x;  // tie rule of two triangles sharing an edge
}

// Lines through a triangle; corners in half cells.
template <class Found>
void cross_triangle(std::array<Vec3d, 3> p, int columns, int rows, const Found& found) {
  const double area = side_of(p[0], p[1], p[2].x, p[2].y);
  if (!(area != 0)) return;
  const bool from_above = area > 0;  // counter-clockwise: its outside faces up
  if (!from_above) std::swap(p[1], p[2]);
  const auto range = [](double a, double b, double c, int count) {
    return std::pair{std::max(0, int(std::ceil(std::max(-1.0, std::min({a, b, c}))))),
                     std::min(count - 1, int(std::floor(std::min(1e9, std::max({a, b, c})))))};
  };
  const auto [x0, x1] = range(p[0].x, p[1].x, p[2].x, columns);
  const auto [y0, y1] = range(p[0].y, p[1].y, p[2].y, rows);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      std::array<double, 3> side;
      bool within = true;
      for (std::size_t i = 0; i < 3 && within; ++i) {
        const Vec3d &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
        side[i] = side_of(a, b, x, y);
        within = is_within(side[i], a, b);
      }
      if (!within) continue;
      const double z =
          (side[0] * p[0].z + side[1] * p[1].z + side[2] * p[2].z) / (side[0] + side[1] + side[2]);
      found(
          Crossing{std::uint32_t(y) * std::uint32_t(columns) + std::uint32_t(x), float(.5 * z), !from_above});
    }
}

}  // namespace

InsideLines::InsideLines(const World& world, std::span<const std::uint32_t> meshes, const Lattice& lattice)
    : columns_(2 * lattice.nx + 1), rows_(2 * lattice.ny + 1) {
  const CancelCheck check;
  std::vector<Crossing> crossings;
  for (const std::uint32_t m : meshes) {
    const Mesh& mesh = world.meshes[m];
    std::vector<Vec3d> corners;
    for (const Vec3d& p : mesh.positions) corners.push_back(lattice.into(p) * 2);
    for (const auto& [i, j, k] : mesh.triangles)
      cross_triangle({corners[i], corners[j], corners[k]}, columns_, rows_, [&](const Crossing& crossing) {
        check();
        crossings.push_back(crossing);
      });
  }
  std::ranges::sort(crossings, [&](const Crossing& a, const Crossing& b) {
    check();
    return a.line != b.line ? a.line < b.line : a.z != b.z ? a.z < b.z : a.enters > b.enters;
  });
  first_.reserve(std::size_t(columns_) * std::size_t(rows_) + 1);
  std::size_t next = 0;
  for (std::uint32_t line = 0; line < std::uint32_t(columns_) * std::uint32_t(rows_); ++line) {
    first_.push_back(std::uint32_t(bounds_.size()));
    std::size_t end = next;
    int all = 0;  // 0: the meshes are closed on this line
    for (; end < crossings.size() && crossings[end].line == line; ++end)
      all += crossings[end].enters ? 1 : -1;
    for (int sheets = 0; next < end; ++next) {
      const int before = std::exchange(sheets, sheets + (crossings[next].enters ? 1 : -1));
      if (all != 0 && sheets < 0) sheets = 0;  // an exit without entry
      if ((before == 0) != (sheets == 0)) bounds_.push_back(crossings[next].z);
    }
    if ((bounds_.size() - first_.back()) % 2 == 1) bounds_.pop_back();
  }
  first_.push_back(std::uint32_t(bounds_.size()));
}

double InsideLines::covered(int column, int row, double low, double high) const {
  double sum = 0;
  const std::span<const float> ends = bounds(column, row);
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2)
    sum += std::max(0.0, std::min(high, double(ends[i + 1])) - std::max(low, double(ends[i])));
  return sum;
}

bool InsideLines::contains(int column, int row, double z) const {
  const std::span<const float> ends = bounds(column, row);
  return (std::ranges::upper_bound(ends, float(z)) - ends.begin()) % 2 == 1;
}

}  // namespace opaline
