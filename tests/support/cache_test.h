// SPDX-License-Identifier: GPL-3.0-or-later
// Made-up results of stages, and a folder to keep them in.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "../core/scratch_folder.h"
#include "cache/cache_folder.h"
#include "core/random.h"
#include "stages/stage_cache.h"
#include "stages/stage_codecs.h"

namespace opaline::test {

inline float number(std::uint64_t index) {
  return float(unit_double(hash_bits(7, index))) - .5f;
}

inline Vec3f vector(std::uint64_t index) {
  return {number(3 * index), number(3 * index + 1), number(3 * index + 2)};
}

inline const std::vector<std::uint32_t> kMeshes{4, 2};
inline constexpr std::uint32_t kWorldMeshes = 12, kTriangles = 100;

/// Each mesh a row of triangles, somewhere; the same in all, so that samples may be of any two.
inline const World& some_world() {
  static const World world = [] {
    World made;
    Mesh row;
    for (std::uint32_t i = 0; i < kTriangles + 2; ++i)
      row.positions.push_back({.5 * i, double(i % 2), .01 * i});
    for (std::uint32_t i = 0; i < kTriangles; ++i) row.triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
    made.measures.assign(kWorldMeshes, measures_of(row));
    made.meshes.assign(kWorldMeshes, row);
    made.diagonal = .5 * kTriangles;
    return made;
  }();
  return world;
}

/// What samples of some_samples are asked for.
inline SampledSurface surface_of(std::size_t count, std::span<const std::uint32_t> meshes = kMeshes) {
  return {some_world(), meshes, count};
}

/// On meshes 4 and 2.
inline SurfaceSamples some_samples(std::size_t count) {
  const double area = 2 * surface_area(some_world().meshes[0]);
  SurfaceSamples surface{{}, area, .125};
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t mesh = i % 3 == 0 ? 4u : 2u, triangle = std::uint32_t(i / 2 % kTriangles);
    const float u = (number(i) + .5f) / 2, v = (number(i + 1) + .5f) / 2;
    const SurfacePoint point = surface_point(some_world().meshes[mesh], triangle, u, v);
    surface.samples.push_back({mesh, triangle, u, v, point.position, point.normal,
                               float(area / double(count)), point.position + .01f * vector(i)});
  }
  return surface;
}

inline LightTransfer some_light(std::size_t count) {
  LightTransfer transfer{{}, .01};
  for (std::size_t i = 0; i < count; ++i) transfer.weights.push_back(.5f + number(i));
  return transfer;
}

inline Octree some_octree(std::size_t count) {
  std::vector<FluxSample> flux;
  for (const SurfaceSample& s : some_samples(count).samples)
    flux.push_back({s.position, s.area, RgbF(1 + s.u), s.normal});
  return build_octree(flux);
}

inline Exitance some_value(std::uint64_t i) {
  return {vector(i), vector(i + 1), vector(i + 2), vector(i + 3)};
}

/// Of `count` vertices; every third patch of each triangle has a lattice.
inline SurfaceCache some_exitance(std::uint32_t count) {
  SurfaceCache exitance;
  exitance.own_irradiance = {.25f, .5f, .75f};
  exitance.splits.resize(kWorldMeshes);
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    exitance.splits[4].push_back({4 * i, 2});
    exitance.splits[2].push_back({i, 1});
  }
  for (std::uint32_t i = 0; i < 4 * kTriangles; ++i) {
    exitance.patches.push_back({{i % count, (i + 1) % count, (i + 2) % count},
                                i % 3 == 0 ? SurfaceCache::kNone : std::uint32_t(exitance.lattices.size())});
    if (i % 3 == 0) continue;
    exitance.lattices.push_back({std::uint32_t(exitance.lattice_nodes.size()), 2});
    for (std::uint32_t n = 0; n < 6; ++n) exitance.lattice_nodes.push_back((i + n) % count);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    exitance.vertices.push_back({some_value(i), vector(i), {vector(i + 4), vector(i + 5), vector(i + 6)}});
    exitance.nodes.push_back(some_value(i + 9));
  }
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
