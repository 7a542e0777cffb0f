// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/topology.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace opaline {
namespace {

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 32);
}

/// A hash set of indices, compared by their values; returns the first equal one.
class FirstEqual {
 public:
  explicit FirstEqual(std::size_t count)
      : slots_(std::bit_ceil(2 * count + 2), none), mask_(slots_.size() - 1) {}

  template <class Equal>
  std::uint32_t find_or_insert(std::uint32_t index, std::uint64_t hash, Equal equal) {
    std::size_t slot = hash & mask_;
    while (slots_[slot] != none && !equal(slots_[slot], index)) slot = (slot + 1) & mask_;
    if (slots_[slot] == none) slots_[slot] = index;
    return slots_[slot];
  }

  static constexpr std::uint32_t none = 0xffffffff;

  /// none if there is none
  template <class Equal>
  std::uint32_t find(std::uint32_t index, std::uint64_t hash, Equal equal) const {
    std::size_t slot = hash & mask_;
    while (slots_[slot] != none && !equal(slots_[slot], index)) slot = (slot + 1) & mask_;
    return slots_[slot];
  }

 private:
  std::vector<std::uint32_t> slots_;
  std::size_t mask_;
};

template <class T>
std::uint64_t hash_vector(std::uint64_t hash, const Vec3<T>& v) {
  // adding 0 makes -0 and 0 the same bits
  for (std::size_t i = 0; i < 3; ++i) hash = mix(hash, std::bit_cast<std::uint64_t>(double(v[i]) + 0.0));
  return hash;
}

template <class Position>
std::vector<std::uint32_t> weld_all(const std::vector<Position>& positions,
                                    const std::vector<Vec3f>& normals) {
  FirstEqual first(positions.size());
  std::vector<std::uint32_t> same(positions.size());
  const auto equal = [&](std::uint32_t a, std::uint32_t b) {
    return positions[a] == positions[b] && (normals.empty() || normals[a] == normals[b]);
  };
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    std::uint64_t hash = hash_vector(0, positions[v]);
    if (!normals.empty()) hash = hash_vector(hash, normals[v]);
    same[v] = first.find_or_insert(v, hash, equal);
  }
  return same;
}

/// Finds vertices differing by rounding, by cells of four times its width.
class SeamFinder {
 public:
  SeamFinder(const std::vector<Vec3d>& positions, double reach)
      : positions_(positions), reach_(reach), first_(positions.size()) {}

  /// For each vertex, the first earlier one within reach that is not joined itself.
  std::vector<std::uint32_t> run() {
    std::vector<std::uint32_t> same(positions_.size());
    for (std::uint32_t v = 0; v < same.size(); ++v) same[v] = find(v);
    return same;
  }

 private:
  static constexpr double kCell = 4;  // over the reach

  std::uint32_t find(std::uint32_t v) {
    const Vec3d place =
        positions_[v] / (kCell * reach_) + Vec3d(.5);  // round numbers lie in the middle of cells
    Vec3d cell, step;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cell[axis] = std::floor(place[axis]);
      const double within = place[axis] - cell[axis];
      step[axis] = within < 1 / kCell ? -1 : within > 1 - 1 / kCell ? 1 : 0;
    }
    const auto is_near = [&](std::uint32_t a, std::uint32_t b) {
      const Vec3d apart = positions_[a] - positions_[b];
      return max_component(component_max(apart, -apart)) <= reach_;
    };
    std::uint32_t found = FirstEqual::none;
    for (unsigned corner = 1; corner < 8; ++corner) {  // cells across nearby faces, edges and corners
      Vec3d other = cell;
      bool is_other = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if ((corner >> axis & 1) == 0) continue;
        other[axis] += step[axis];
        is_other &= step[axis] != 0;
      }
      if (is_other) found = std::min(found, first_.find(v, hash_vector(0, other), is_near));
    }
    return found != FirstEqual::none ? found : first_.find_or_insert(v, hash_vector(0, cell), is_near);
  }

  const std::vector<Vec3d>& positions_;
  double reach_;
  FirstEqual first_;
};

}  // namespace

bool is_sliver(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, bc = c - b, ca = a - c;
  const Vec3d twice_area = cross(ab, ca);
  const double longest = std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
  return dot(twice_area, twice_area) <= 1e-24 * longest * longest;
}

void join_seams(SourceMesh& mesh) {
  std::vector<Vec3d>& p = mesh.positions;
  double extent = 0;
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle)
      extent = std::max(extent, max_component(component_max(p[v], -p[v])));
  constexpr int kReach = -44;
  if (!(extent > std::ldexp(std::numeric_limits<double>::min(), -kReach))) return;
  const double reach = std::ldexp(1., std::ilogb(extent) + kReach);
  const std::vector<std::uint32_t> same = SeamFinder(p, reach).run();
  for (const auto& [a, b, c] : mesh.triangles) {
    const bool collapses = same[a] == same[b] || same[b] == same[c] || same[c] == same[a];
    if (collapses && !is_sliver(p[a], p[b], p[c])) return;
  }
  for (std::size_t v = 0; v < p.size(); ++v) p[v] = p[same[v]];
}

std::vector<std::uint32_t> weld(const std::vector<Vec3d>& positions, const std::vector<Vec3f>& normals) {
  return weld_all(positions, normals);
}

std::vector<std::uint32_t> weld(const std::vector<Vec3f>& positions) {
  return weld_all(positions, {});
}

std::vector<bool> find_duplicates(const std::vector<Triangle>& triangles, const EdgeTable& edges) {
  std::vector<bool> duplicate(triangles.size());
  std::vector<std::array<std::uint32_t, 2>> beside;  // triangles at an edge: third vertex, index
  edges.for_each([&](std::uint32_t, std::uint32_t high, std::span<const std::uint32_t> corners) {
    if (corners.size() < 2) return;
    beside.clear();
    for (const std::uint32_t corner : corners)
      beside.push_back({triangles[corner / 3][(corner % 3 + 2) % 3], corner / 3});
    std::ranges::sort(beside);
    for (std::size_t i = 1; i < beside.size(); ++i)  // at its two lower vertices, each triangle once
      if (beside[i][0] > high && beside[i][0] == beside[i - 1][0]) duplicate[beside[i][1]] = true;
  });
  return duplicate;
}

EdgeTable::EdgeTable(const std::vector<Triangle>& triangles, std::size_t vertices)
    : start_(vertices + 1), entries_(3 * triangles.size()) {
  const auto each_edge = [&](auto visit) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto [lower, higher] = std::minmax({triangles[t][k], triangles[t][(k + 1) % 3]});
        visit(lower, higher, 3 * t + k);
      }
    }
  };
  each_edge([&](std::uint32_t lower, std::uint32_t, std::uint32_t) { ++start_[lower + 1]; });
  for (std::size_t v = 0; v < vertices; ++v) start_[v + 1] += start_[v];
  std::vector<std::uint32_t> end(start_.begin(), start_.end() - 1);
  each_edge([&](std::uint32_t lower, std::uint32_t higher, std::uint32_t corner) {
    entries_[end[lower]++] = {higher, corner};
  });
  for (std::size_t v = 0; v < vertices; ++v)
    std::sort(entries_.begin() + start_[v], entries_.begin() + start_[v + 1],
              [](const Entry& a, const Entry& b) {
                return a.higher != b.higher ? a.higher < b.higher : a.corner < b.corner;
              });
}

}  // namespace opaline
