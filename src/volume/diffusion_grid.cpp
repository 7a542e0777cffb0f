// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/diffusion_grid.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/cancel_check.h"
#include "volume/cut_cube.h"

namespace opaline {
namespace {

constexpr double kLeastVolume = .05;    // least volume of a lattice cell; smaller ones are dropped
constexpr double kLeastDistance = .25;  // least distance of two centres
constexpr float kLeastAcross = 1e-6f;   // squared; less is rounding
constexpr std::array<double, 3> kThirds{.25, .5, .25};  // trapezoids through three lines

/// A flag for each cell of one size.
class Flags {
 public:
  Flags(int nx, int ny, int nz)
      : n_{nx, ny, nz}, flags_(std::size_t(nx) * std::size_t(ny) * std::size_t(nz)) {}

  bool at(int i, int j, int k) const { return flags_[place(i, j, k)]; }
  void set(int i, int j, int k) {
    if (i >= 0 && j >= 0 && k >= 0 && i < n_[0] && j < n_[1] && k < n_[2]) flags_[place(i, j, k)] = 1;
  }
  Flags halved() const {
    Flags result((n_[0] + 1) / 2, (n_[1] + 1) / 2, (n_[2] + 1) / 2);
    for_each([&](int i, int j, int k) { result.set(i / 2, j / 2, k / 2); });
    return result;
  }
  /// Includes all 26 neighbours.
  Flags widened() const {
    Flags result(n_[0], n_[1], n_[2]);
    for_each([&](int i, int j, int k) {
      for (int z = k - 1; z <= k + 1; ++z)
        for (int y = j - 1; y <= j + 1; ++y)
          for (int x = i - 1; x <= i + 1; ++x) result.set(x, y, z);
    });
    return result;
  }

 private:
  std::size_t place(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(n_[1]) + std::size_t(j)) * std::size_t(n_[0]) + std::size_t(i);
  }
  template <class Visit>
  void for_each(const Visit& visit) const {
    std::size_t place = 0;
    for (int k = 0; k < n_[2]; ++k)
      for (int j = 0; j < n_[1]; ++j)
        for (int i = 0; i < n_[0]; ++i)
          if (flags_[place++]) visit(i, j, k);
  }

  std::array<int, 3> n_;
  std::vector<std::uint8_t> flags_;
};

/// Cells of size 2 crossed by the surface.
Flags met_by_surface(const InsideLines& lines, const Lattice& lattice,
                     std::span<const DiffusionGrid::Facet> surface) {
  Flags met(lattice.nx / 2, lattice.ny / 2, lattice.nz / 2);
  for (const auto& [p, normal, area] : surface) met.set(int(p.x) / 2, int(p.y) / 2, int(p.z) / 2);
  for (int row = 0; row < lines.rows(); ++row)
    for (int column = 0; column < lines.columns(); ++column)
      for (const float z : lines.bounds(column, row))
        for (const int j : {(row - 1) / 4, row / 4})
          for (const int i : {(column - 1) / 4, column / 4}) met.set(i, j, int(z) / 2);
  return met;
}

}  // namespace

struct DiffusionGrid::Builder {
  Builder(DiffusionGrid& grid_, const InsideLines& lines_, const Lattice& lattice,
          std::span<const Facet> surface)
      : grid(grid_), lines(lines_), levels{met_by_surface(lines_, lattice, surface)} {
    while (levels.size() < 3) levels.push_back(levels.back().halved());
    for (Flags& level : levels) level = level.widened();
  }

  /// Plane of the surface in a cell of size 1.
  struct Plane {
    Vec3d normal{};     // outward
    double height = 0;  // over the cell's middle
  };

  // Adds a cell of this size at (i, j, k), divided near the surface.
  void fill(int i, int j, int k, int size) {
    check();
    if (size == 1) return fill_one(i, j, k);
    const int level = size == 2 ? 0 : size == 4 ? 1 : 2;
    if (levels[std::size_t(level)].at(i / size, j / size, k / size)) {
      const int half = size / 2;
      for (int z = 0; z < size; z += half)
        for (int y = 0; y < size; y += half)
          for (int x = 0; x < size; x += half) fill(i + x, j + y, k + z, half);
      return;
    }
    const double middle = .5 * size;
    if (!lines.contains(2 * i + size, 2 * j + size, k + middle)) return;
    add({Vec3f(Vec3d(i + middle, j + middle, k + middle)), float(size * size * size), size}, {i, j, k});
  }

  void fill_one(int i, int j, int k) {
    double volume = 0;
    Vec3d moment;
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) {
        const double weight = kThirds[std::size_t(x)] * kThirds[std::size_t(y)];
        const int column = 2 * i + x, row = 2 * j + y;
        const double covered = lines.covered(column, row, k, k + 1);
        if (!(covered > 0)) continue;
        // The covered part touches one end of the cell or, if whole, its centre.
        const bool low = lines.contains(column, row, k);
        const bool high = lines.contains(column, row, k + 1);
        const double z = low == high ? .5 : low ? .5 * covered : 1 - .5 * covered;
        volume += weight * covered;
        moment += Vec3d(.5 * x, .5 * y, z) * (weight * covered);
      }
    if (!(volume > kLeastVolume)) return;
    add({Vec3f(Vec3d(i, j, k) + moment / volume), float(volume)}, {i, j, k});
  }

  void add(const Cell& cell, std::array<int, 3> corner) {
    const int size = cell.size;
    const auto index = std::uint32_t(grid.cells_.size());
    grid.cells_.push_back(cell);
    corners.push_back(corner);
    if (size == kLargest) {
      grid.bricks_[brick] = kWhole + index;
      return;
    }
    if (grid.bricks_[brick] == kNone) {
      grid.bricks_[brick] = std::uint32_t(grid.slots_.size());
      grid.slots_.resize(grid.slots_.size() + 512, kNone);
    }
    for (int z = 0; z < size; ++z)
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
          grid.slots_[grid.bricks_[brick] +
                      std::uint32_t((((corner[2] + z) & 7) * 8 + ((corner[1] + y) & 7)) * 8 +
                                    ((corner[0] + x) & 7))] = index;
  }

  // Volume of a cell inside the body. Lines have a resolution of a quarter cell for surfaces parallel to
  // them; a plane through the facets is exact.
  void weigh_by_planes(std::span<const Facet> surface) {
    constexpr double kLeastAgreement = .97;  // least agreement of the facets' normals
    std::vector<Plane> sums(grid.cells_.size());
    std::vector<double> areas(grid.cells_.size());
    for (const auto& [position, normal, area] : surface) {
      const std::uint32_t cell = grid.at(position);
      if (cell == kNone || size_of(cell) > 1) continue;
      sums[cell].normal += Vec3d(normal) * double(area);
      sums[cell].height += dot(Vec3d(position) - middle_of(cell), Vec3d(normal)) * double(area);
      areas[cell] += double(area);
    }
    planes.resize(grid.cells_.size());
    for (std::uint32_t cell = 0; cell < planes.size(); ++cell) {
      const auto& [normal, height] = sums[cell];
      if (!(areas[cell] > 0 && length(normal) > kLeastAgreement * areas[cell])) continue;
      const Plane plane{normalized(normal), height / areas[cell]};
      const PartOfCube part = part_behind(plane.normal, plane.height);
      if (!(part.volume > 0)) continue;
      planes[cell] = plane;
      grid.cells_[cell].centre = Vec3f(middle_of(cell) + part.centre);
      grid.cells_[cell].volume = float(std::max(kLeastVolume, part.volume));
    }
  }

  // Middle of a cell of size 1.
  Vec3d middle_of(std::uint32_t cell) const {
    const auto& [i, j, k] = corners[cell];
    return {i + .5, j + .5, k + .5};
  }
  int size_of(std::uint32_t cell) const { return grid.cells_[cell].size; }

  // Aperture of a lattice face, its fraction inside: behind the planes of both cells, where they have one.
  // in    corner: of the lattice cell above the face
  double aperture(std::uint32_t below, std::uint32_t above, const std::array<int, 3>& corner,
                  std::size_t axis) const {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    double sum = 0;
    int count = 0;
    for (const auto& [plane, offset] : {std::pair{planes[below], .5}, std::pair{planes[above], -.5}}) {
      if (!plane) continue;
      sum += share_behind({plane->normal[u], plane->normal[v]}, plane->height - offset * plane->normal[axis]);
      ++count;
    }
    if (count > 0) return sum / count;
    return aperture_by_lines(corner[0], corner[1], corner[2], int(axis));
  }

  // Aperture of the lattice face below (i, j, k) along an axis, from the lines.
  double aperture_by_lines(int i, int j, int k, int axis) const {
    double sum = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const int m = int(n);
      if (axis == 0) sum += kThirds[n] * lines.covered(2 * i, 2 * j + m, k, k + 1);
      if (axis == 1) sum += kThirds[n] * lines.covered(2 * i + m, 2 * j, k, k + 1);
      for (std::size_t x = 0; axis == 2 && x < 3; ++x)
        sum += kThirds[n] * kThirds[x] * double(lines.contains(2 * i + int(x), 2 * j + m, k));
    }
    return sum;
  }

  template <class Found>
  void link_above(std::uint32_t cell, int axis, const Found& found) const {
    const int size = size_of(cell), half = std::max(1, size / 2), parts = size > 1 ? 2 : 1;
    std::uint32_t before = kNone;
    for (int v = 0; v < parts; ++v)
      for (int u = 0; u < parts; ++u) {
        std::array<int, 3> p = corners[cell];
        p[std::size_t(axis)] += size;
        p[std::size_t((axis + 1) % 3)] += u * half;
        p[std::size_t((axis + 2) % 3)] += v * half;
        const std::uint32_t other = grid.at(p[0], p[1], p[2]);
        if (other == kNone || other == before) continue;
        before = other;
        const int edge = std::min(size, size_of(other));
        const double area = edge > 1 ? edge * edge : aperture(cell, other, p, std::size_t(axis));
        if (area > 0) found(other, area);
      }
  }

  struct Pair {
    std::uint32_t a, b;
    float conductance;
  };

  // Couples the small cells on one side of a larger one, so the flux through that side depends on their mean
  // fluence. Uncoupled, they would conduct light along the side through the larger cell.
  void link_across(std::uint32_t cell, std::size_t axis, int step, std::vector<Pair>& pairs) const {
    const int size = size_of(cell), half = size / 2;
    std::array<std::uint32_t, 4> others;
    std::size_t count = 0;
    for (int v = 0; v < 2; ++v)
      for (int u = 0; u < 2; ++u) {
        std::array<int, 3> p = corners[cell];
        p[axis] += step > 0 ? size : -1;
        p[(axis + 1) % 3] += u * half;
        p[(axis + 2) % 3] += v * half;
        const std::uint32_t other = grid.at(p[0], p[1], p[2]);
        if (other != kNone && size_of(other) == half) others[count++] = other;
      }
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < i; ++j)
        pairs.push_back({others[i], others[j], -float(half * half / (.75 * size * double(count)))});
  }

  // Links neighbouring cells. The flux of decaying light is that at the midpoint of two centres, inside the
  // larger cell. Half of the volume between midpoint and face moves to the smaller cell: the reflectance of a
  // half space is then second-order accurate.
  void link() {
    std::vector<Pair> pairs;
    std::vector<float> given(grid.cells_.size());
    for (std::uint32_t cell = 0; cell < grid.cells_.size(); ++cell)
      for (int axis = 0; axis < 3; ++axis) {
        check();
        link_above(cell, axis, [&](std::uint32_t other, double area) {
          const auto component = std::size_t(axis);
          const double here = double(grid.cells_[cell].centre[component]),
                       there = double(grid.cells_[other].centre[component]);
          pairs.push_back({cell, other, float(area / std::max(kLeastDistance, there - here))});
          const double face = corners[cell][component] + size_of(cell);
          const auto half = float(.5 * (.5 * (here + there) - face) * area);
          given[cell] += half;
          given[other] -= half;
          Vec3f across = grid.cells_[other].centre - grid.cells_[cell].centre;
          across[component] = 0;
          if (size_of(cell) == 1 && size_of(other) == 1 && dot(across, across) > kLeastAcross)
            grid.oblique_.push_back({cell, other, pairs.back().conductance, across});
        });
        for (const int step : {-1, 1})
          if (size_of(cell) > 1) link_across(cell, std::size_t(axis), step, pairs);
      }
    for (std::size_t i = 0; i < given.size(); ++i) {
      float& volume = grid.cells_[i].volume;
      volume = std::max(.25f * volume, volume + given[i]);
    }
    std::vector<std::uint32_t>& first = grid.first_link_;
    first.assign(grid.cells_.size() + 1, 0);
    for (const Pair& pair : pairs) ++first[pair.a + 1], ++first[pair.b + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    grid.links_.resize(2 * pairs.size());
    for (const Pair& pair : pairs) {
      grid.links_[next[pair.a]++] = {pair.b, pair.conductance};
      grid.links_[next[pair.b]++] = {pair.a, pair.conductance};
    }
  }

  const CancelCheck check;
  DiffusionGrid& grid;
  const InsideLines& lines;
  std::vector<Flags> levels;                 // cells of sizes 2, 4, 8 to divide
  std::size_t brick = 0;                     // current
  std::vector<std::array<int, 3>> corners;   // corners of the cells
  std::vector<std::optional<Plane>> planes;  // planes of the cells with exactly one
};

DiffusionGrid::DiffusionGrid(const InsideLines& lines, const Lattice& lattice, std::span<const Facet> surface)
    : bricks_of_{unsigned(lattice.nx / kLargest), unsigned(lattice.ny / kLargest),
                 unsigned(lattice.nz / kLargest)},
      bricks_(std::size_t(bricks_of_[0]) * bricks_of_[1] * bricks_of_[2], kNone) {
  Builder builder(*this, lines, lattice, surface);
  for (int k = 0; k < lattice.nz; k += kLargest)
    for (int j = 0; j < lattice.ny; j += kLargest)
      for (int i = 0; i < lattice.nx; i += kLargest, ++builder.brick) builder.fill(i, j, k, kLargest);
  builder.weigh_by_planes(surface);
  builder.link();
}

void DiffusionGrid::find_around(const Vec3f& point, const Vec3f& normal,
                                std::vector<std::uint32_t>& found) const {
  constexpr float kFromPlane = .9f;
  found.clear();
  for (const float x : {-1.f, 0.f, 1.f})
    for (const float y : {-1.f, 0.f, 1.f})
      for (const float z : {-1.f, 0.f, 1.f}) {
        const Vec3f beside(x, y, z);
        if (std::abs(dot(beside, normal)) > kFromPlane) continue;
        const std::uint32_t cell = at(point + beside);
        if (cell != kNone && std::ranges::find(found, cell) == found.end()) found.push_back(cell);
      }
}

}  // namespace opaline
