// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/read_mesh.h"

#include <cmath>
#include <filesystem>

#include "core/input_file.h"
#include "core/machine_memory.h"
#include "geometry/formats/mesh_format.h"
#include "geometry/mesh_file.h"
#include "geometry/topology.h"
#include "opaline/error.h"
#include "scene/unread_format.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

/// ".a, .b or .c"
std::string known_extensions() {
  std::string list;
  for (std::size_t i = 0; i < kMeshFormats.size(); ++i) {
    if (i > 0) list += i + 1 < kMeshFormats.size() ? ", " : " or ";
    list += extension_of(kMeshFormats[i]);
  }
  return list;
}

/// Rejects an empty file, and one far longer than its mesh, or than memory, before reading it.
void check_size(const std::string& path, const InputFile& file) {
  constexpr std::uintmax_t spare = 1 << 20;  // programs append notes of their own
  constexpr std::uintmax_t header = 1 << 12;
  const std::uintmax_t size = file.size();
  if (size == 0) throw bad_file(path, "the mesh file is empty");
  const MeshFormat* format = find_mesh_format(path);
  const bool may_announce = format != nullptr && format->announced_length != nullptr;
  const std::uintmax_t announced = may_announce ? format->announced_length(file.read(0, header)) : 0;
  if (announced > 0 && size > 2 * announced + spare)
    throw bad_file(path, "the file is much longer than its header states",
                   std::to_string(announced) + " bytes", std::to_string(size));
  if (const std::size_t memory = available_memory(); size > memory)
    throw bad_file(path, "the mesh file does not fit into memory", std::to_string(memory) + " bytes",
                   std::to_string(size));
}

/// Indices of triangles' corners must fit 32 bits.
void require_indexable(const std::string& path, const SourceMesh& mesh) {
  constexpr std::size_t limit = std::size_t(1) << 30;
  if (mesh.positions.size() > limit || mesh.triangles.size() > limit)
    throw bad_file(path, "the mesh is too large", "at most 2^30 vertices and triangles");
}

/// Such UVs become 0, with a warning.
void clear_uvs_not_finite(const std::string& path, SourceMesh& mesh) {
  std::size_t corners = 0;
  for (CornerUvs& uvs : mesh.uvs)
    for (std::array<float, 2>& uv : uvs)
      if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) {
        uv = {};
        ++corners;
      }
  if (corners > 0)
    mesh.warnings.push_back(path + ": UVs not finite at " + std::to_string(corners) + " of " +
                            std::to_string(3 * mesh.uvs.size()) + " corners of triangles are taken as 0");
}

}  // namespace

std::string read_mesh_bytes(const std::string& path) {
  const InputFile file(path, "mesh file", did_you_mean_file);
  check_size(path, file);
  return file.read_all();
}

bool is_mesh_file_name(const std::string& path) {
  return find_mesh_format(path) != nullptr;
}

bool names_no_files(const std::string& path) {
  const MeshFormat* format = find_mesh_format(path);
  return format == nullptr || format->contents == nullptr;
}

std::string mesh_contents(const std::string& path) {
  return names_no_files(path) ? read_mesh_bytes(path) : find_mesh_format(path)->contents(path);
}

SourceMesh read_mesh(const std::string& path, const std::string& part, MeshUvs uvs,
                     const std::optional<AnimationTime>& pose) {
  const MeshFormat* format = find_mesh_format(path);
  if (format == nullptr) {
    if (const std::string unread = unread_format(path); !unread.empty()) throw bad_file(path, unread);
    const std::string extension = fs::path(path).extension().string();
    throw bad_file(path, "unknown mesh format", "a name that ends in " + known_extensions(),
                   extension.empty() ? "no extension" : "'" + extension + "'");
  }
  if (!part.empty() && format->read_part == nullptr)
    throw bad_file(path, "the format has no parts", "no \"part\"", '"' + part + '"');
  if (pose && format->read_posed == nullptr)
    throw bad_file(path, "the format has no animations", "no \"animation_time\"");
  const InputFile file(path, "mesh file", did_you_mean_file);
  check_size(path, file);
  std::string bytes = names_no_files(path) ? file.read_all() : "";  // others are read with their files
  SourceMesh mesh = pose           ? format->read_posed(path, part, pose, uvs)
                    : part.empty() ? format->read(path, bytes, uvs)
                                   : format->read_part(path, part, bytes, uvs);
  require_indexable(path, mesh);
  clear_uvs_not_finite(path, mesh);
  join_seams(mesh);
  return mesh;
}

}  // namespace opaline
