// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles of a glTF asset (GLB or glTF file), by primitive.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "opaline/scene.h"
#include "opaline/vec3.h"
#include "scene/scene_properties.h"

namespace opaline {

/// One primitive of the asset, in metres: in the mesh's own space, or in the scene's if skinned or animated.
struct GltfPart {
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;             ///< empty, or one per vertex, of any length
  std::vector<std::array<float, 2>> uvs;  ///< empty, or one per vertex; v upwards
  std::vector<Tangent> tangents;          ///< empty, or one per vertex
  std::vector<RgbF> colors;               ///< empty, or one per vertex; linear, 0 to 1
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::string> warnings;
};

/// in    part: "mesh/primitive", or "mesh/primitive/node", their indices; uvs: UV request; pose: of an animation; none: at
///       rest
/// out   every index in range, every position finite and below 1e18; strips and fans as triangles
/// error Error{bad_input} naming the file, the accessor and its element: no such part, points or lines, data
///       out of bounds or of a type invalid in glTF
GltfPart read_gltf_part(const std::string& path, const std::string& part, MeshUvs uvs = MeshUvs::unread,
                        const std::optional<AnimationTime>& pose = {});

/// Contents of a part: changes with the bytes of the file or of its buffers.
std::string gltf_contents(const std::string& path);

}  // namespace opaline
