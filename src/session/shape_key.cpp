// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/shape_key.h"

#include "opaline/geometry/mesh_file.h"

namespace opaline {
namespace {

struct AddSource {
  KeyBuilder& key;
  void operator()(const MeshFile& mesh) const {
    key.add(mesh.path).add(mesh_contents(mesh.path)).add(mesh.part);
    key.add(mesh.fill_holes).add(mesh.fit_size.value_or(0));
  }
  void operator()(const SphereShape& s) const { key.add(s.center).add(s.radius).add(s.fineness); }
  void operator()(const BoxShape& s) const { key.add(s.low).add(s.high); }
  void operator()(const QuadShape& s) const { key.add(s.corner).add(s.u).add(s.v); }
  void operator()(const SlabShape& s) const { key.add(s.center).add(s.width).add(s.depth).add(s.thickness); }
  void operator()(const TorusShape& s) const {
    key.add(s.center).add(s.major_radius).add(s.minor_radius).add(s.fineness);
  }
};

}  // namespace

StageKey source_key(const Shape& shape, MeshUvs uvs) {
  KeyBuilder key("source", 1);
  key.add(std::uint64_t(shape.source.index()));
  if (uvs == MeshUvs::required) key.add(true);
  if (uvs == MeshUvs::if_any || uvs == MeshUvs::with_tangents) key.add(uvs);
  try {
    std::visit(AddSource{key}, shape.source);
  } catch (const Error& failure) {
    throw told_at(shape.place, failure);
  }
  return key.key();
}

StageKey shape_key(const Shape& shape, const StageKey& source) {
  KeyBuilder key("shape", 1);
  const bool may_be_open = !shape.medium;  // then an open quad is no reason for a warning
  key.add(source).add(shape.to_world).add(shape.normals).add(may_be_open);
  key.add(shape.name);  // messages have it
  return key.key();
}

}  // namespace opaline
