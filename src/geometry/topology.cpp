// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/topology.h"

#include <bit>

namespace opaline {
namespace {

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 32);
}

/// A hash set of indices, compared by what they stand for; answers with the first equal one.
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

 private:
  static constexpr std::uint32_t none = 0xffffffff;
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

}  // namespace

std::vector<std::uint32_t> weld(const std::vector<Vec3d>& positions, const std::vector<Vec3f>& normals) {
  return weld_all(positions, normals);
}

std::vector<std::uint32_t> weld(const std::vector<Vec3f>& positions) {
  return weld_all(positions, {});
}

std::vector<bool> find_duplicates(const std::vector<Triangle>& triangles) {
  FirstEqual first(triangles.size());
  std::vector<bool> duplicate(triangles.size());
  const auto sorted = [&](std::uint32_t t) {
    Triangle key = triangles[t];
    std::sort(key.begin(), key.end());
    return key;
  };
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Triangle key = sorted(t);
    const std::uint64_t hash = mix(mix(mix(0, key[0]), key[1]), key[2]);
    duplicate[t] =
        first.find_or_insert(t, hash, [&](std::uint32_t a, std::uint32_t) { return sorted(a) == key; }) != t;
  }
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
