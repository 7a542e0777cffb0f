// SPDX-License-Identifier: GPL-3.0-or-later
// Made-up results of stages, and a folder to keep them in.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "../core/scratch_folder.h"
#include "opaline/cache/cache_folder.h"
#include "opaline/cache/stage_cache.h"
#include "opaline/core/random.h"

namespace opaline::test {

inline float number(std::uint64_t index) {
  return float(unit_double(hash_bits(7, index))) - .5f;
}

inline Vec3f vector(std::uint64_t index) {
  return {number(3 * index), number(3 * index + 1), number(3 * index + 2)};
}

/// On meshes 4 and 2.
inline SurfaceSamples some_samples(std::size_t count) {
  SurfaceSamples surface{{}, 12.25, .125};
  for (std::size_t i = 0; i < count; ++i)
    surface.samples.push_back({i % 3 == 0 ? 4u : 2u, std::uint32_t(i / 2), number(i), -number(i), vector(i),
                               vector(i + 1), number(i + 2), vector(i + 3)});
  return surface;
}
inline const std::vector<std::uint32_t> kMeshes{4, 2};

inline LightTransfer some_light(std::size_t count) {
  LightTransfer transfer{{}, .01};
  for (std::size_t i = 0; i < count; ++i) transfer.weights.push_back(number(i));
  return transfer;
}

inline Octree some_octree(std::size_t count) {
  std::vector<FluxSample> flux;
  for (std::size_t i = 0; i < count; ++i)
    flux.push_back({vector(i), .5f + number(i), RgbF(1 + number(i)), vector(i + 5)});
  return build_octree(flux);
}

inline Exitance some_value(std::uint64_t i) {
  return {vector(i), vector(i + 1), vector(i + 2), vector(i + 3)};
}

/// On meshes 4 and 2 of a world of 6, the second with one triangle.
inline SurfaceCache some_exitance(std::size_t count) {
  SurfaceCache exitance;
  exitance.own_irradiance = {.25f, .5f, .75f};
  exitance.splits.resize(6);
  for (std::uint32_t i = 0; i < count; ++i) {
    exitance.splits[4].push_back({i, i + 1});
    exitance.patches.push_back({{i, i + 1, i + 2}, i % 3 == 0 ? SurfaceCache::kNone : i});
    exitance.vertices.push_back({some_value(i), vector(i), {vector(i + 4), vector(i + 5), vector(i + 6)}});
    exitance.lattices.push_back({i, 2});
    exitance.lattice_nodes.push_back(7 * i);
    exitance.nodes.push_back(some_value(i + 9));
  }
  exitance.splits[2].push_back({99, 1});
  return exitance;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// How many entries are whole; -1 if any is not.
inline int whole_entries(const std::string& folder) {
  int count = 0;
  for (const CacheEntry& entry : list_cache(folder)) {
    if (!problem_of(folder, entry).empty()) return -1;
    ++count;
  }
  return count;
}

}  // namespace opaline::test
