// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/triangle_list.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "core/morton.h"
#include "core/parallel.h"
#include "geometry/surface_point.h"

namespace opaline {
namespace {

constexpr std::size_t kChunk = 4096;

struct Keyed {
  std::uint64_t key;
  TriangleId id;
};

/// True if two triangles have the same corners in the same cyclic order.
bool coincide(const TriangleList::Corners& s, const TriangleList::Corners& t) {
  const std::array<Vec3d, 3> b{t.a, t.b, t.c};
  for (std::size_t k = 0; k < 3; ++k)
    if (s.a == b[k] && s.b == b[(k + 1) % 3] && s.c == b[(k + 2) % 3]) return true;
  return false;
}

/// Drops triangles coinciding with one of an earlier mesh.
void drop_coincident(std::vector<Keyed>& keyed, const TriangleList& triangles) {
  constexpr std::size_t kCompared = 64;  // maximum number of compared triangles per key
  std::vector<std::size_t> kept;
  std::vector<bool> is_dropped(keyed.size());
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    const std::size_t end = std::min(keyed.size(), i + kCompared);
    for (std::size_t j = i + 1; !is_dropped[i] && j < end && keyed[j].key == keyed[i].key; ++j)
      if (keyed[j].id.mesh != keyed[i].id.mesh &&
          coincide(triangles.corners(keyed[i].id), triangles.corners(keyed[j].id)))
        is_dropped[j] = true;
    if (!is_dropped[i]) kept.push_back(i);
  }
  if (kept.empty() || kept.size() == keyed.size()) return;
  for (std::size_t k = 0; k < kept.size(); ++k) keyed[k] = keyed[kept[k]];
  keyed.resize(kept.size());
}

}  // namespace

TriangleList::TriangleList(const World& world, std::span<const std::uint32_t> meshes) : world_(world) {
  for (const std::uint32_t m : meshes)
    for (std::uint32_t t = 0; t < world.meshes[m].triangles.size(); ++t) ids_.push_back({m, t});
  if (ids_.empty()) return;
  const Bounds box = bounds(world, meshes);
  const Vec3d size = box.high - box.low;
  const double largest = std::max({size.x, size.y, size.z}),
               scale = largest > 0 ? double((1 << 20) - 1) / largest : 0;
  std::vector<Keyed> keyed(ids_.size());
  parallel_chunks(keyed.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d p = (corners(ids_[i]).centre() - box.low) * scale;
      keyed[i] = {morton_key(std::uint64_t(p.x), std::uint64_t(p.y), std::uint64_t(p.z)), ids_[i]};
    }
  });
  tbb::parallel_sort(keyed, [](const Keyed& a, const Keyed& b) {
    return std::tie(a.key, a.id.mesh, a.id.triangle) < std::tie(b.key, b.id.mesh, b.id.triangle);
  });
  if (meshes.size() > 1) drop_coincident(keyed, *this);
  ids_.resize(keyed.size());
  std::ranges::transform(keyed, ids_.begin(), &Keyed::id);
  measure();
}

TriangleList::TriangleList(const World& world, std::span<const std::uint32_t> meshes,
                           const TriangleList& before, std::span<const std::uint32_t> meshes_before)
    : world_(world), ids_(before.ids_) {
  for (TriangleId& id : ids_)
    id.mesh = meshes[std::size_t(std::ranges::find(meshes_before, id.mesh) - meshes_before.begin())];
  measure();
}

// Areas and normals.
void TriangleList::measure() {
  normals_.resize(ids_.size());
  cumulative_.resize(ids_.size());
  parallel_chunks(ids_.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Corners t = corners(ids_[i]);
      const Vec3d normal = cross(t.b - t.a, t.c - t.a);
      cumulative_[i] = 0.5 * length(normal);
      normals_[i] = Vec3f(normalized(normal));
      const SurfacePoint centre = surface_point(mesh(ids_[i]), ids_[i].triangle, 1.f / 3, 1.f / 3);
      if (dot(centre.geometric, normals_[i]) < 0) normals_[i] = -normals_[i];  // reversed by a fold
    }
  });
  std::partial_sum(cumulative_.begin(), cumulative_.end(), cumulative_.begin());
}

}  // namespace opaline
