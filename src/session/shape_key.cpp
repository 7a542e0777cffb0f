// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/shape_key.h"

#include <sys/stat.h>

#include <ctime>
#include <optional>

#include "bodies/surface_textures.h"
#include "geometry/mesh_file.h"
#include "scene/source_place.h"

namespace opaline {
namespace {

struct AddSource {
  KeyBuilder& key;
  const StageKey& contents;  // contents of a mesh file
  void operator()(const MeshFile& mesh) const {
    key.add(mesh.path).add(contents).add(mesh.part);
    key.add(mesh.fill_holes.has_value()).add(mesh.fill_holes.value_or(false));
    key.add(mesh.fit_size.value_or(0));
    key.add(mesh.vertex_colors.has_value()).add(mesh.vertex_colors.value_or(false));
    key.add(mesh.crease_angle.value_or(-1));
    if (mesh.subdivide > 0) key.add(mesh.subdivide);
    if (mesh.pose) key.add(mesh.pose->animation).add(mesh.pose->seconds);
  }
  void operator()(const SphereShape& s) const { key.add(s.center).add(s.radius).add(s.fineness); }
  void operator()(const BoxShape& s) const { key.add(s.low).add(s.high); }
  void operator()(const QuadShape& s) const { key.add(s.corner).add(s.u).add(s.v); }
  void operator()(const SlabShape& s) const { key.add(s.center).add(s.width).add(s.depth).add(s.thickness); }
  void operator()(const TorusShape& s) const {
    key.add(s.center).add(s.major_radius).add(s.minor_radius).add(s.fineness);
  }
};

/// None: an unknown file, or one changed so recently that another change might not alter its record.
std::optional<StageKey> record_of(const std::string& path) {
  constexpr std::time_t kSettled = 3;  // seconds: file systems keep times to 2 at the coarsest
  struct stat file;
  if (::stat(path.c_str(), &file) != 0 || std::time(nullptr) - file.st_ctim.tv_sec < kSettled) return {};
  KeyBuilder key("record of a file", 1);
  key.add(file.st_dev).add(file.st_ino).add(file.st_size);
  key.add(file.st_mtim.tv_sec).add(file.st_mtim.tv_nsec).add(file.st_ctim.tv_sec).add(file.st_ctim.tv_nsec);
  return key.key();
}

}  // namespace

StageKey SourceKeys::contents(const std::string& path) {
  const std::optional<StageKey> record = names_no_files(path) ? record_of(path) : std::nullopt;
  const auto known = hashed_.find(path);
  if (record && known != hashed_.end() && known->second.record == *record) return known->second.contents;
  const StageKey contents = KeyBuilder("mesh file", 1).add(mesh_contents(path)).key();
  if (record) hashed_.insert_or_assign(path, Hashed{*record, contents});
  return contents;
}

StageKey SourceKeys::key(const Shape& shape, MeshUvs uvs) {
  KeyBuilder key("source", 2);
  key.add(std::uint64_t(shape.source.index()));
  if (uvs == MeshUvs::required) key.add(true);
  if (uvs == MeshUvs::if_any || uvs == MeshUvs::with_tangents) key.add(uvs);
  try {
    const auto* const mesh = std::get_if<MeshFile>(&shape.source);
    const StageKey of_file = mesh != nullptr ? contents(mesh->path) : StageKey{};
    std::visit(AddSource{key, of_file}, shape.source);
  } catch (const Error& failure) {
    throw told_at(shape.place, failure);
  }
  return key.key();
}

StageKey shape_key(const Shape& shape, const StageKey& source) {
  KeyBuilder key("shape", 1);
  key.add(source).add(shape.to_world).add(shape.normals).add(shape.medium.has_value());
  key.add(shape.name);  // used in messages
  if (shape.displacement)
    add_to_key(key.add(std::string("displacement")).add(solid_to_world(shape)), *shape.displacement);
  if (shape.opacity) add_to_key(key.add(std::string("opacity")), *shape.opacity);
  return key.key();
}

}  // namespace opaline
