// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh formats. Each has one file in this folder, with everything specific to it but its name.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "geometry/source_mesh.h"
#include "opaline/scene.h"
#include "scene/mesh_formats.h"
#include "scene/scene_properties.h"

namespace opaline {

struct MeshFormat {
  /// Reads the mesh from a file's bytes, which may be overwritten or freed; see read_mesh.
  /// error Error{bad_input} naming the file, and the line in formats with lines
  SourceMesh (*read)(const std::string& path, std::string& bytes, MeshUvs uvs);

  /// A part of the mesh, see MeshFile::part. Null: files of the format have no parts.
  SourceMesh (*read_part)(const std::string& path, const std::string& part, std::string& bytes,
                          MeshUvs uvs) = nullptr;

  /// The same at a time of an animation. Null: files of the format have none.
  SourceMesh (*read_posed)(const std::string& path, const std::string& part,
                           const std::optional<AnimationTime>& pose, MeshUvs uvs) = nullptr;

  /// Contents of a mesh file with references to other files. Null: its bytes.
  std::string (*contents)(const std::string& path) = nullptr;

  /// The length of the whole file as its header announces it; 0 if it does not. Null: the format never does.
  /// in    start: of the file, 4 KiB or all
  std::uintmax_t (*announced_length)(std::string_view start) = nullptr;
};

// Each is defined in the format's file.
extern const MeshFormat obj_format, ply_format, stl_format, off_format, glb_format, gltf_format;

/// In the order of kMeshFormats.
inline constexpr std::array kFormats{&obj_format, &ply_format, &stl_format,
                                     &off_format, &glb_format, &gltf_format};
static_assert(kFormats.size() == kMeshFormats.size());

/// Extension of a format: lower case, with the dot.
std::string extension_of(std::string_view format);

/// Format by the file name's extension, in upper or lower case; null: unknown.
const MeshFormat* find_mesh_format(const std::string& path);

}  // namespace opaline
