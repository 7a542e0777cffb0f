// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/cell_parts.h"

#include <algorithm>

#include "opaline/core/parallel.h"

namespace opaline {

SurfaceCells collect_cells(const TriangleList& triangles, std::span<const SurfacePiece> pieces,
                           std::span<const std::uint32_t> order, std::span<const std::uint32_t> meshes) {
  std::vector<std::uint32_t> firsts(meshes.empty() ? 0 : std::ranges::max(meshes) + 1);
  for (std::uint32_t first = 0; const std::uint32_t m : meshes) {
    firsts[m] = first;
    first += std::uint32_t(triangles.mesh({m, 0}).triangles.size());
  }
  std::vector<std::uint32_t> rank(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
  SurfaceCells cells{std::vector<std::uint32_t>(order.size() + 1), std::vector<CellPart>(pieces.size())};
  for (const SurfacePiece& piece : pieces) ++cells.first[rank[piece.sample] + 1];
  for (std::size_t i = 0; i < order.size(); ++i) cells.first[i + 1] += cells.first[i];
  std::vector<std::uint32_t> next(cells.first.begin(), cells.first.end() - 1);
  for (const SurfacePiece& piece : pieces) {
    const TriangleId id = triangles.id(piece.triangle);
    cells.parts[next[rank[piece.sample]]++] = {firsts[id.mesh] + id.triangle, piece.share, piece.u, piece.v};
  }
  return cells;
}

CountedTriangles::CountedTriangles(const World& world, std::span<const std::uint32_t> meshes)
    : world_(world), meshes_(meshes) {
  std::size_t count = 0;
  for (const std::uint32_t m : meshes) {
    firsts_.push_back(count);
    count += world.meshes[m].triangles.size();
  }
  areas_.resize(count);
  for (std::size_t place = 0; place < meshes.size(); ++place) {
    const Mesh& mesh = world.meshes[meshes[place]];
    parallel_chunks(mesh.triangles.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t t = begin; t < end; ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3d normal =
            cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        areas_[firsts_[place] + t] = 0.5 * length(normal);
      }
    });
  }
}

TriangleList::Corners CountedTriangles::corners(std::size_t triangle) const {
  const auto place = std::size_t(std::ranges::upper_bound(firsts_, triangle) - firsts_.begin()) - 1;
  const Mesh& mesh = world_.meshes[meshes_[place]];
  const auto& [a, b, c] = mesh.triangles[triangle - firsts_[place]];
  return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

SurfaceShare carried_share(const SurfaceCells& cells, std::size_t sample, const CountedTriangles& triangles,
                           const Vec3f& position) {
  const Vec3d origin(position);
  SurfaceShare share;
  for (std::uint32_t i = cells.first[sample]; i < cells.first[sample + 1]; ++i) {
    const CellPart& part = cells.parts[i];
    const double area = double(part.share) * triangles.area(part.triangle);
    const auto [a, b, c] = triangles.corners(part.triangle);
    share.area += area;
    share.moment += (a + (b - a) * double(part.u) + (c - a) * double(part.v) - origin) * area;
  }
  return share;
}

}  // namespace opaline
