// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/cell_parts.h"

#include <algorithm>

#include "core/parallel.h"

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

std::vector<PlainTriangle> plain_triangles(const World& world, std::span<const std::uint32_t> meshes) {
  std::size_t count = 0;
  for (const std::uint32_t m : meshes) count += world.meshes[m].triangles.size();
  std::vector<PlainTriangle> triangles(count);
  PlainTriangle* to = triangles.data();
  for (const std::uint32_t m : meshes) {
    const Mesh& mesh = world.meshes[m];
    parallel_chunks(mesh.triangles.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t t = begin; t < end; ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3d &corner = mesh.positions[a], ab = mesh.positions[b] - corner,
                    ac = mesh.positions[c] - corner;
        to[t] = {Vec3f(corner), Vec3f(ab), Vec3f(ac), float(0.5 * length(cross(ab, ac)))};
      }
    });
    to += mesh.triangles.size();
  }
  return triangles;
}

SurfaceShare carried_share(const SurfaceCells& cells, std::size_t sample,
                           std::span<const PlainTriangle> triangles, const Vec3f& position) {
  SurfaceShare share;
  for (std::uint32_t i = cells.first[sample]; i < cells.first[sample + 1]; ++i) {
    const CellPart& part = cells.parts[i];
    const PlainTriangle& t = triangles[part.triangle];
    const double area = double(part.share) * double(t.area);
    share.area += area;
    share.moment += Vec3d(t.corner - position + t.u_edge * part.u + t.v_edge * part.v) * area;
  }
  return share;
}

}  // namespace opaline
