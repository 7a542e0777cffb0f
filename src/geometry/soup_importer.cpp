// SPDX-License-Identifier: GPL-3.0-or-later
#include "soup_importer.h"

#include <algorithm>

namespace opaline {
namespace {

Vec3f to_vec3f(const OpenMesh::Vec3f& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

SoupImporter::SoupImporter(const MeshScan& scan) : vertex_normals_(scan.vertex_normals) {
  mesh_.positions.reserve(scan.positions.size());
  mesh_.triangles.reserve(scan.triangles);
}

SoupImporter::Handle SoupImporter::add_vertex(const OpenMesh::Vec3f& p) {
  mesh_.positions.push_back(Vec3d(to_vec3f(p)));
  if (vertex_normals_) mesh_.normals.emplace_back();
  return Handle(int(vertices_++));
}

void SoupImporter::set_point(Handle v, const OpenMesh::Vec3f& p) {
  mesh_.positions[std::size_t(v.idx())] = Vec3d(to_vec3f(p));
}

void SoupImporter::set_normal(Handle v, const OpenMesh::Vec3f& n) {
  if (vertex_normals_) mesh_.normals[std::size_t(v.idx())] = to_vec3f(n);
}

OpenMesh::FaceHandle SoupImporter::add_face(const VHandles& corners) {
  for (const Handle v : corners) hash_.add(std::uint64_t(v.idx()));
  if (corners.size() < 3) {
    ++collapsed_;
    return OpenMesh::FaceHandle();
  }
  const auto index = [&](std::size_t i) { return std::uint32_t(corners[i].idx()); };
  for (std::size_t i = 2; i < corners.size(); ++i)
    mesh_.triangles.push_back({index(0), index(i - 1), index(i)});
  return OpenMesh::FaceHandle(int(mesh_.triangles.size() - 1));
}

SourceMesh SoupImporter::take(const std::vector<Vec3d>& exact_positions) {
  std::copy(exact_positions.begin(), exact_positions.end(), mesh_.positions.begin());
  mesh_.collapsed = collapsed_;
  return std::move(mesh_);
}

}  // namespace opaline
