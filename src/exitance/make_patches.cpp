// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/make_patches.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "exitance/surface_patch.h"

namespace opaline {
namespace {

constexpr double kMostSegments = 1024;
// Least cosine between a facet's normal and a vertex's mean normal for sharing the vertex, about 37 degrees.
constexpr float kSmooth = 0.8f;

Vec3f facet_normal(const Mesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3d& p = mesh.positions[a];
  return Vec3f(normalized(cross(mesh.positions[b] - p, mesh.positions[c] - p)));
}

std::vector<Vec3f> mean_facet_normals(const Mesh& mesh) {
  std::vector<Vec3d> sums(mesh.positions.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d& p = mesh.positions[a];
    const Vec3d twice_area = cross(mesh.positions[b] - p, mesh.positions[c] - p);
    sums[a] += twice_area, sums[b] += twice_area, sums[c] += twice_area;
  }
  std::vector<Vec3f> normals;
  for (const Vec3d& sum : sums) normals.push_back(Vec3f(normalized(sum)));
  return normals;
}

class MeshCutter {
 public:
  MeshCutter(const Mesh& mesh, double longest, SurfaceCache& cache, std::vector<Vec3f>& normals)
      : mesh_(mesh),
        longest_(longest),
        cache_(cache),
        normals_(normals),
        shared_(mesh.positions.size(), SurfaceCache::kNone),
        smooth_(!mesh.normals.empty()) {
    if (!smooth_) means_ = mean_facet_normals(mesh);
  }

  void cut(std::vector<SurfaceCache::Split>& splits) {
    std::vector<std::uint32_t> lattice;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const std::uint32_t n = segments_of(mesh_, t, longest_);
      splits.push_back({std::uint32_t(cache_.patches.size()), n});
      if (!smooth_) facet_ = facet_normal(mesh_, t);
      lattice.clear();
      for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i + j <= n; ++i) lattice.push_back(vertex(t, i, j, n));
      for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i + j < n; ++i)
          for (const bool upright : {true, false}) {
            if (!upright && i + j + 1 == n) continue;
            const CellPlace cell{i, j, upright, 0, 0};
            const auto at = [&](std::uint32_t di, std::uint32_t dj) {
              const auto [x, y] = cell.node(1, di, dj);
              return lattice[lattice_index(n, x, y)];
            };
            cache_.patches.push_back({{at(0, 0), at(1, 0), at(0, 1)}});
          }
    }
  }

 private:
  std::uint32_t vertex(std::uint32_t t, std::uint32_t i, std::uint32_t j, std::uint32_t n) {
    const auto& [a, b, c] = mesh_.triangles[t];
    if (i == 0 && j == 0) return corner(a);
    if (i == n) return corner(b);
    if (j == n) return corner(c);
    const Vec3d along_u = mesh_.positions[b] - mesh_.positions[a],
                along_v = mesh_.positions[c] - mesh_.positions[a];
    const Vec3f position(mesh_.positions[a] + along_u * (double(i) / n) + along_v * (double(j) / n));
    if (!smooth_) return add(position, facet_);
    const float u = float(i) / float(n), v = float(j) / float(n);
    const Vec3f normal =
        normalized(mesh_.normals[a] * (1 - u - v) + mesh_.normals[b] * u + mesh_.normals[c] * v);
    if (j == 0) return on_edge(a, b, i, n, position, normal);
    if (i == 0) return on_edge(a, c, j, n, position, normal);
    if (i + j == n) return on_edge(b, c, j, n, position, normal);
    return add(position, normal);
  }

  std::uint32_t corner(std::uint32_t v) {
    const Vec3f position(mesh_.positions[v]);
    if (!smooth_ && dot(means_[v], facet_) < kSmooth) return add(position, facet_);
    if (shared_[v] == SurfaceCache::kNone) shared_[v] = add(position, smooth_ ? mesh_.normals[v] : means_[v]);
    return shared_[v];
  }

  std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, std::uint32_t k, std::uint32_t n,
                        const Vec3f& position, const Vec3f& normal) {
    if (a > b) std::swap(a, b), k = n - k;
    const auto [known, is_new] = edges_.try_emplace({a, b, k, n}, std::uint32_t(cache_.vertices.size()));
    return is_new ? add(position, normal) : known->second;
  }

  std::uint32_t add(const Vec3f& position, const Vec3f& normal) {
    cache_.vertices.push_back({{}, position, {}});
    normals_.push_back(normal);
    return std::uint32_t(cache_.vertices.size() - 1);
  }

  const Mesh& mesh_;
  double longest_;
  SurfaceCache& cache_;
  std::vector<Vec3f>& normals_;
  std::vector<std::uint32_t> shared_;  // vertex of the cache, one per vertex of the mesh
  bool smooth_;
  std::vector<Vec3f> means_;  // mean normals of the facets at each vertex, if not smooth
  Vec3f facet_;
  std::map<std::array<std::uint32_t, 4>, std::uint32_t> edges_;  // vertices on subdivided edges
};

}  // namespace

std::uint32_t segments_of(const Mesh& mesh, std::uint32_t triangle, double longest) {
  const auto& corners = mesh.triangles[triangle];
  double side = 0;
  for (std::size_t k = 0; k < 3; ++k)
    side = std::max(side, length(mesh.positions[corners[(k + 1) % 3]] - mesh.positions[corners[k]]));
  return std::uint32_t(std::clamp(std::ceil(side / longest), 1.0, kMostSegments));
}

std::vector<Vec3f> make_patches(const World& world, std::span<const std::uint32_t> meshes, double longest,
                                SurfaceCache& cache) {
  std::vector<Vec3f> normals;
  cache.splits.resize(world.meshes.size());
  for (const std::uint32_t m : meshes)
    MeshCutter(world.meshes[m], longest, cache, normals).cut(cache.splits[m]);
  return normals;
}

}  // namespace opaline
