// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/displace.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "image/solid_lookup.h"
#include "image/uv_lookup.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

constexpr std::size_t kChunk = 1024;
constexpr double kFiltered = .5;  // part of the sides of a triangle

/// Heights at the corners, by the UVs.
std::vector<std::array<float, 3>> corner_heights(const Mesh& mesh, const Texture& texture) {
  std::vector<std::array<float, 3>> heights(mesh.triangles.size());
  parallel_chunks(heights.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const CornerUvs& uvs = mesh.uvs[t];
        const auto side = [&](std::size_t to) {
          return std::array<double, 2>{kFiltered * double(uvs[to][0] - uvs[k][0]),
                                       kFiltered * double(uvs[to][1] - uvs[k][1])};
        };
        const TexturePlace place = uv_lookup(texture, uvs[k], {side((k + 1) % 3), side((k + 2) % 3)});
        heights[t][k] = texture.source->image()->at(place)[texture.channel];
      }
  });
  return heights;
}

/// Mean length of the sides at each vertex.
std::vector<double> side_lengths(const Mesh& mesh) {
  std::vector<double> sums(mesh.positions.size());
  std::vector<int> counts(sums.size());
  for (const auto& corners : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      sums[corners[k]] += length(mesh.positions[corners[(k + 1) % 3]] - mesh.positions[corners[k]]);
      ++counts[corners[k]];
    }
  for (std::size_t v = 0; v < sums.size(); ++v) sums[v] /= std::max(1, counts[v]);
  return sums;
}

/// Heights at the vertices, by their positions in the space of the shape.
std::vector<float> solid_heights(const Mesh& mesh, const Texture& texture, const Transform& to_world) {
  const SolidSpace space = solid_space(to_world);
  const auto inside = [&](const Vec3d& outside) { return space.inside(outside); };
  const auto inside_normal = [&](const Vec3d& normal) {
    return normalized(Vec3d{dot(to_world.x, normal), dot(to_world.y, normal), dot(to_world.z, normal)});
  };
  const std::vector<double> sides = side_lengths(mesh);
  std::vector<float> heights(mesh.positions.size());
  parallel_chunks(heights.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3d normal(mesh.normals[v]);
      Vec3d x, y;
      tangent_frame(normal, x, y);
      const double width = kFiltered * sides[v];
      heights[v] = solid_value(texture, {inside(mesh.positions[v] - space.origin), inside_normal(normal),
                                         inside(x * width), inside(y * width)})[texture.channel];
    }
  });
  return heights;
}

std::vector<float> mean_heights(const Mesh& mesh, const std::vector<std::array<float, 3>>& at_corners) {
  std::vector<float> heights(mesh.positions.size());
  std::vector<int> counts(heights.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3 && mesh.uvs[t] != CornerUvs{}; ++k) {  // others fill holes, without UVs
      heights[mesh.triangles[t][k]] += at_corners[t][k];
      ++counts[mesh.triangles[t][k]];
    }
  for (std::size_t v = 0; v < heights.size(); ++v) heights[v] /= float(std::max(1, counts[v]));
  return heights;
}

}  // namespace

SourceMesh displaced(Mesh mesh, const Shape& shape) {
  const Texture& texture = *shape.displacement;
  const std::vector<float> heights = is_solid(texture) ? solid_heights(mesh, texture, solid_to_world(shape))
                                                       : mean_heights(mesh, corner_heights(mesh, texture));
  SourceMesh moved;
  moved.positions = std::move(mesh.positions);
  for (std::size_t v = 0; v < moved.positions.size(); ++v)
    moved.positions[v] += Vec3d(mesh.normals[v]) * (double(heights[v]) * texture.scale.x);
  moved.triangles = std::move(mesh.triangles);
  moved.uvs = std::move(mesh.uvs);
  moved.tangents = std::move(mesh.tangents);
  moved.colors = std::move(mesh.colors);
  return moved;
}

}  // namespace opaline
