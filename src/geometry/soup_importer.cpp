// SPDX-License-Identifier: GPL-3.0-or-later
#include "soup_importer.h"

#include <algorithm>

namespace opaline {
namespace {

constexpr std::uint32_t no_normal_yet = 0xffffffff, end_of_chain = 0xfffffffe;

Vec3f to_vec3f(const OpenMesh::Vec3f& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

SoupImporter::SoupImporter(const MeshScan& scan)
    : vertex_normals_(scan.vertex_normals), corner_normals_(scan.corner_normals) {
  mesh_.positions.reserve(scan.positions.size());
  mesh_.triangles.reserve(scan.triangles);
}

SoupImporter::Handle SoupImporter::add_vertex(const OpenMesh::Vec3f& p) {
  mesh_.positions.push_back(Vec3d(to_vec3f(p)));
  if (vertex_normals_) mesh_.normals.emplace_back();
  if (corner_normals_) next_variant_.push_back(no_normal_yet);
  return Handle(int(vertices_++));
}

void SoupImporter::set_point(Handle v, const OpenMesh::Vec3f& p) {
  mesh_.positions[std::size_t(v.idx())] = Vec3d(to_vec3f(p));
}

void SoupImporter::set_normal(Handle v, const OpenMesh::Vec3f& n) {
  if (corner_normals_) {
    pending_.emplace_back(std::uint32_t(v.idx()), to_vec3f(n));
  } else if (vertex_normals_) {
    mesh_.normals[std::size_t(v.idx())] = to_vec3f(n);
  }
}

/// The copy of the vertex that has this normal.
std::uint32_t SoupImporter::variant(std::uint32_t vertex, const Vec3f& normal) {
  if (next_variant_[vertex] == no_normal_yet) {
    next_variant_[vertex] = end_of_chain;
    mesh_.normals[vertex] = normal;
    return vertex;
  }
  std::uint32_t at = vertex;
  while (mesh_.normals[at] != normal && next_variant_[at] != end_of_chain) at = next_variant_[at];
  if (mesh_.normals[at] == normal) return at;
  const auto added = std::uint32_t(mesh_.positions.size());
  next_variant_[at] = added;
  next_variant_.push_back(end_of_chain);
  mesh_.normals.push_back(normal);
  mesh_.positions.push_back(mesh_.positions[vertex]);
  return added;
}

OpenMesh::FaceHandle SoupImporter::add_face(const VHandles& corners) {
  for (const Handle v : corners) hash_.add(std::uint64_t(v.idx()));
  scratch_ = corners;
  for (Handle& v : scratch_) {
    for (const auto& [vertex, normal] : pending_) {
      if (vertex != std::uint32_t(v.idx())) continue;
      v = Handle(int(variant(vertex, normal)));
      break;
    }
  }
  pending_.clear();
  if (corners.size() < 3) {
    ++collapsed_;
    return OpenMesh::FaceHandle();
  }
  const auto index = [&](std::size_t i) { return std::uint32_t(scratch_[i].idx()); };
  for (std::size_t i = 2; i < scratch_.size(); ++i)
    mesh_.triangles.push_back({index(0), index(i - 1), index(i)});
  return OpenMesh::FaceHandle(int(mesh_.triangles.size() - 1));
}

SourceMesh SoupImporter::take(const std::vector<Vec3d>& exact_positions) {
  std::copy(exact_positions.begin(), exact_positions.end(), mesh_.positions.begin());
  if (corner_normals_) {
    for (std::size_t v = 0; v < exact_positions.size(); ++v) {
      std::uint32_t at = next_variant_[v];
      for (; at < end_of_chain; at = next_variant_[at]) mesh_.positions[at] = exact_positions[v];
    }
  }
  mesh_.collapsed = collapsed_;
  return std::move(mesh_);
}

}  // namespace opaline
