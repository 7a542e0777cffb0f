// SPDX-License-Identifier: GPL-3.0-or-later
// GLB and glTF 2.0: a primitive of a mesh, without its node, unless the node poses it.
#include <utility>

#include "geometry/formats/file_checks.h"
#include "geometry/formats/gltf_part.h"
#include "geometry/formats/mesh_format.h"
#include "geometry/formats/vertex_colors.h"

namespace opaline {
namespace {

SourceMesh read_posed(const std::string& path, const std::string& part,
                      const std::optional<AnimationTime>& pose, MeshUvs uvs) {
  GltfPart primitive = read_gltf_part(path, part, uvs, pose);
  SourceMesh mesh;
  mesh.positions = std::move(primitive.positions);
  mesh.normals = std::move(primitive.normals);
  mesh.collapsed = std::erase_if(primitive.triangles, [](const Triangle& triangle) {
    const auto& [a, b, c] = triangle;
    return a == b || b == c || c == a;
  });
  mesh.triangles = std::move(primitive.triangles);
  give_uvs(mesh, primitive.uvs);
  if (!primitive.tangents.empty())
    for (const auto& [a, b, c] : mesh.triangles)
      mesh.tangents.push_back({primitive.tangents[a], primitive.tangents[b], primitive.tangents[c]});
  if (!primitive.colors.empty()) give_vertex_colors(mesh, primitive.colors);
  mesh.warnings = std::move(primitive.warnings);
  return mesh;
}

SourceMesh read_primitive(const std::string& path, const std::string& part, std::string&, MeshUvs uvs) {
  return read_posed(path, part, {}, uvs);
}

SourceMesh read_without_part(const std::string& path, std::string&, MeshUvs uvs) {
  return read_posed(path, "", {}, uvs);
}

constexpr MeshFormat kFormat{.read = read_without_part,
                             .read_part = read_primitive,
                             .read_posed = read_posed,
                             .contents = gltf_contents};

}  // namespace

constinit const MeshFormat glb_format = kFormat, gltf_format = kFormat;

}  // namespace opaline
