// SPDX-License-Identifier: GPL-3.0-or-later
// In place of repair_mesh.cpp in builds without CGAL (OPALINE_MESH_REPAIR): holes stay open.
#include <boost/pending/disjoint_sets.hpp>
#include <map>

#include "geometry/repair_mesh.h"

namespace opaline {

bool has_small_holes(const std::vector<Vec3d>&, const std::vector<Triangle>&, const std::vector<Edge>&) {
  return false;
}

HoleFilling fill_holes(const std::vector<Vec3d>& positions, const std::vector<Triangle>&,
                       const EdgeTable& edges, FillHoles, bool) {
  boost::disjoint_sets_with_storage<> touching(positions.size());
  std::vector<std::uint32_t> open;  // a vertex of each open edge
  edges.for_each([&](std::uint32_t low, std::uint32_t high, std::span<const std::uint32_t> corners) {
    if (corners.size() != 1) return;
    touching.union_set(low, high);
    open.push_back(low);
  });
  std::map<std::size_t, std::size_t> sizes;  // edges of each rim
  for (const std::uint32_t vertex : open) ++sizes[touching.find_set(vertex)];
  HoleFilling result;
  for (const auto& [apex, size] : sizes) result.unfilled.push_back(size);
  return result;
}

}  // namespace opaline
