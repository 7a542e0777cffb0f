// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/fluence_gradient.h"

#include <vector>

#include "core/parallel.h"

namespace opaline {

std::array<Vec3f, 3> gradient_at(const DiffusionGrid& grid, std::span<const Channels> fluence,
                                 std::uint32_t i) {
  constexpr float kLeastSquare = .05f;  // along an axis without neighbours there is no slope
  const DiffusionGrid::Cell& cell = grid.cells()[i];
  Vec3f diagonal(kLeastSquare), off;  // off: of yz, zx, xy
  std::array<Vec3f, 3> sums{};
  for (const DiffusionGrid::Link& link : grid.links(i)) {
    if (!(link.conductance > 0)) continue;
    const Vec3f apart = grid.cells()[link.to].centre - cell.centre;
    diagonal += apart * apart * link.conductance;
    off += Vec3f(apart.y * apart.z, apart.z * apart.x, apart.x * apart.y) * link.conductance;
    for (std::size_t c = 0; c < 3; ++c)
      sums[c] += apart * (link.conductance * (fluence[link.to].c[c] - fluence[i].c[c]));
  }
  const Vec3f row0(diagonal.x, off.z, off.y), row1(off.z, diagonal.y, off.x), row2(off.y, off.x, diagonal.z);
  const Vec3f minors0 = cross(row1, row2), minors1 = cross(row2, row0), minors2 = cross(row0, row1);
  const float inverse = 1 / dot(row0, minors0);  // symmetric and positive
  for (Vec3f& sum : sums) sum = (minors0 * sum.x + minors1 * sum.y + minors2 * sum.z) * inverse;
  return sums;
}

void add_oblique_flow(DiffusionProblem& problem, std::span<const Channels> fluence) {
  const DiffusionGrid& grid = problem.grid;
  std::vector<std::uint32_t> place(fluence.size(), DiffusionGrid::kNone), cells;
  for (const DiffusionGrid::ObliqueLink& link : grid.oblique())
    for (const std::uint32_t cell : {link.a, link.b})
      if (place[cell] == DiffusionGrid::kNone) {
        place[cell] = std::uint32_t(cells.size());
        cells.push_back(cell);
      }
  std::vector<std::array<Vec3f, 3>> gradients(cells.size());
  parallel_chunks(cells.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) gradients[i] = gradient_at(grid, fluence, cells[i]);
  });
  for (const DiffusionGrid::ObliqueLink& link : grid.oblique()) {
    const Channels diffusivity = problem.between(link.a, link.b);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3f gradient = (gradients[place[link.a]][c] + gradients[place[link.b]][c]) * .5f;
      const float flow = diffusivity.c[c] * link.conductance * dot(gradient, link.across);
      problem.source[link.a].c[c] -= flow;
      problem.source[link.b].c[c] += flow;
    }
  }
}

}  // namespace opaline
