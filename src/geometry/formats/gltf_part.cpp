// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/formats/gltf_part.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

#include "asset_files/gltf_accessor.h"
#include "asset_files/gltf_instances.h"
#include "asset_files/gltf_uv_set.h"
#include "geometry/formats/gltf_pose.h"
#include "geometry/formats/gltf_triangles.h"

namespace opaline {
namespace {

constexpr double coordinate_limit = 1e18;

struct PartIndex {
  std::size_t mesh, primitive;
  std::optional<std::size_t> node, instance;  ///< pose of this node, and its instance
};

std::string known_parts(const GltfModel& gltf) {
  std::string text;
  std::size_t parts = 0;
  constexpr std::size_t most = 8;
  for (std::size_t m = 0; m < gltf.meshes.size(); ++m)
    for (std::size_t p = 0; p < gltf.meshes[m].primitives.size(); ++p)
      if (parts++ < most)
        text += (text.empty() ? "\"" : ", \"") + std::to_string(m) + '/' + std::to_string(p) + '"';
  if (parts > most) text += " and " + std::to_string(parts - most) + " more";
  return text.empty() ? "a file with meshes" : text;
}

/// The whole text as a number; -1: not one.
std::int64_t whole_number(std::string_view text) {
  std::int64_t value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : -1;
}

/// "mesh/primitive", "mesh/primitive/node" for a node with this mesh, or "mesh/primitive/node/instance"; none: no such
/// part.
std::optional<PartIndex> part_index(const GltfModel& gltf, std::string_view part) {
  std::array<std::size_t, 4> numbers{};
  std::size_t count = 0;
  for (bool has_more = true; has_more; ++count) {
    const std::size_t slash = std::min(part.find('/'), part.size());
    const std::int64_t number = whole_number(part.substr(0, slash));
    if (count == numbers.size() || number < 0) return {};
    numbers[count] = std::size_t(number);
    has_more = slash < part.size();
    part.remove_prefix(slash + (has_more ? 1 : 0));
  }
  const auto [mesh, primitive, node, instance] = numbers;
  if (count < 2 || mesh >= gltf.meshes.size() || primitive >= gltf.meshes[mesh].primitives.size()) return {};
  if (count == 2) return PartIndex{mesh, primitive, {}, {}};
  if (node >= gltf.nodes.size() || gltf.nodes[node].mesh != mesh) return {};
  if (count == 3) return PartIndex{mesh, primitive, node, {}};
  return PartIndex{mesh, primitive, node, instance};
}

PartIndex find_part(const GltfModel& gltf, const std::string& part) {
  if (const std::optional<PartIndex> index = part_index(gltf, part)) return *index;
  throw bad_file(gltf.path, part.empty() ? "requires a part of the asset" : "has no such part",
                 "\"part\" as \"mesh/primitive\": " + known_parts(gltf), '"' + part + '"');
}

/// The only node with the part's mesh, for a pose.
std::size_t only_node_of(const GltfModel& gltf, std::size_t mesh, const std::string& part) {
  std::optional<std::size_t> only;
  std::size_t nodes = 0;
  for (std::size_t i = 0; i < gltf.nodes.size(); ++i)
    if (gltf.nodes[i].mesh == mesh && nodes++ == 0) only = i;
  if (nodes != 1)
    throw bad_file(gltf.path, "\"animation_time\" requires a part at a node",
                   "\"part\" as \"mesh/primitive/node\": " + std::to_string(nodes) + " nodes have the mesh",
                   '"' + part + '"');
  return *only;
}

/// The corners of all triangles, in the order of the vertices.
class TriangleList {
 public:
  TriangleList(const GltfModel& gltf, const GltfPrimitive& primitive, std::string place)
      : gltf_(gltf), primitive_(primitive), place_(std::move(place)) {}

  void read(GltfPart& part) {
    if (primitive_.indices != kNoRecord) {
      indices_ = read_indices(gltf_, primitive_.indices);
      check(part.positions.size());
    } else {
      indices_.resize(part.positions.size());
      for (std::size_t i = 0; i < indices_.size(); ++i) indices_[i] = std::uint32_t(i);
    }
    const std::size_t mode = primitive_.mode;
    if (mode == kGltfTriangles)
      list(part);
    else if (mode == kGltfTriangleStrip)
      strip(part);
    else
      fan(part);
  }

 private:
  void check(std::size_t vertices) const {
    for (std::size_t i = 0; i < indices_.size(); ++i)
      if (indices_[i] >= vertices)
        fail_at(gltf_.path, place_ + ".indices: " + record_name("accessors", primitive_.indices),
                "element " + std::to_string(i) + " points at no vertex", "below " + std::to_string(vertices),
                std::to_string(indices_[i]));
  }

  void list(GltfPart& part) const {
    for (std::size_t i = 0; i + 2 < indices_.size(); i += 3)
      part.triangles.push_back({indices_[i], indices_[i + 1], indices_[i + 2]});
    if (const std::size_t rest = indices_.size() % 3; rest > 0)
      part.warnings.push_back(gltf_.path + ": " + place_ + ": the last " + std::to_string(rest) +
                              " corners form no triangle and are ignored");
  }

  /// Every other triangle of a strip has the opposite winding.
  void strip(GltfPart& part) const {
    for (std::size_t i = 0; i + 2 < indices_.size(); ++i)
      part.triangles.push_back({indices_[i], indices_[i + 1 + i % 2], indices_[i + 2 - i % 2]});
  }

  void fan(GltfPart& part) const {
    for (std::size_t i = 1; i + 1 < indices_.size(); ++i)
      part.triangles.push_back({indices_[i], indices_[i + 1], indices_[0]});
  }

  const GltfModel& gltf_;
  const GltfPrimitive& primitive_;
  std::string place_;
  std::vector<std::uint32_t> indices_;
};

void check_positions(const GltfModel& gltf, std::uint32_t accessor, const std::vector<Vec3d>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3d& p = positions[i];
    if (std::abs(p.x) < coordinate_limit && std::abs(p.y) < coordinate_limit &&
        std::abs(p.z) < coordinate_limit)
      continue;
    char got[160];
    std::snprintf(got, sizeof got, "(%g, %g, %g)", p.x, p.y, p.z);
    fail_at(gltf.path, record_name("accessors", accessor),
            "element " + std::to_string(i) + " is not a position", "finite coordinates below 1e18", got);
  }
}

/// error unless their number equals the positions'
void check_count(const GltfModel& gltf, std::uint32_t accessor, std::size_t count, const GltfPart& part,
                 const char* what) {
  if (count != part.positions.size())
    fail_at(gltf.path, record_name("accessors", accessor),
            std::string("has the wrong number of ") + what + "s",
            std::to_string(part.positions.size()) + ", the number of positions", std::to_string(count));
}

void read_normals(const GltfModel& gltf, const GltfPrimitive& primitive, GltfPart& part) {
  const auto found = primitive.attributes.find("NORMAL");
  if (found == primitive.attributes.end()) return;
  const std::vector<Vec3d> normals = read_vectors(gltf, found->second);
  check_count(gltf, found->second, normals.size(), part, "normal");
  part.normals.reserve(normals.size());
  for (const Vec3d& n : normals) {
    const bool usable = is_finite(n) && dot(n, n) < coordinate_limit;
    part.normals.push_back(usable ? Vec3f(n) : Vec3f());
  }
}

/// glTF's v increases downwards.
void read_uvs(const GltfModel& gltf, const GltfPrimitive& primitive, GltfPart& part) {
  const auto found = primitive.attributes.find(uv_attribute(uv_set_of(gltf, primitive)));
  if (found == primitive.attributes.end()) return;
  part.uvs = read_pairs(gltf, found->second);
  check_count(gltf, found->second, part.uvs.size(), part, "UV");
  for (auto& uv : part.uvs) uv[1] = 1 - uv[1];
}

/// Tangents require the file's normals (glTF 2.0, 3.7.2.1).
void read_tangents(const GltfModel& gltf, const GltfPrimitive& primitive, GltfPart& part) {
  const auto found = primitive.attributes.find("TANGENT");
  if (found == primitive.attributes.end() || part.normals.empty()) return;
  const std::vector<std::array<double, 4>> tangents = read_quadruples(gltf, found->second);
  check_count(gltf, found->second, tangents.size(), part, "tangent");
  part.tangents.reserve(tangents.size());
  for (const auto& [x, y, z, w] : tangents) {
    const Vec3d direction{x, y, z};
    const bool usable = is_finite(direction) && dot(direction, direction) < coordinate_limit;
    part.tangents.push_back({usable ? Vec3f(direction) : Vec3f(), w < 0 ? -1.0f : 1.0f});
  }
}

/// Linear; its opacity is ignored.
void read_colors(const GltfModel& gltf, const GltfPrimitive& primitive, GltfPart& part) {
  const auto found = primitive.attributes.find("COLOR_0");
  if (found == primitive.attributes.end()) return;
  const auto take = [&](double r, double g, double b) {
    Vec3d color{r, g, b};
    for (std::size_t c = 0; c < 3; ++c) color[c] = color[c] > 0 ? std::min(color[c], 1.0) : 0;
    part.colors.emplace_back(color);
  };
  if (gltf.accessors[found->second].type == "VEC3")
    for (const auto& [r, g, b] : read_vectors(gltf, found->second)) take(r, g, b);
  else
    for (const auto& [r, g, b, a] : read_quadruples(gltf, found->second)) take(r, g, b);
  check_count(gltf, found->second, part.colors.size(), part, "colour");
}

}  // namespace

GltfPart read_gltf_part(const GltfModel& gltf, const std::string& name, MeshUvs uvs, const GltfState* state) {
  PartIndex index = find_part(gltf, name);
  if (state != nullptr && !index.node) index.node = only_node_of(gltf, index.mesh, name);
  const GltfPrimitive& primitive = gltf.meshes[index.mesh].primitives[index.primitive];
  const std::string place =
      record_name("meshes", index.mesh) + '.' + record_name("primitives", index.primitive);
  if (primitive.mode < kGltfTriangles || primitive.mode > kGltfTriangleFan)
    fail_at(gltf.path, place, "has no triangles", "a mode of 4, 5 or 6", std::to_string(primitive.mode));
  const auto positions = primitive.attributes.find("POSITION");
  if (positions == primitive.attributes.end())
    fail_at(gltf.path, place, "has no positions", "the attribute POSITION");
  GltfPart part;
  part.positions = read_vectors(gltf, positions->second);
  check_positions_type(gltf, positions->second);
  check_positions(gltf, positions->second, part.positions);
  read_normals(gltf, primitive, part);
  if (uvs != MeshUvs::unread) read_uvs(gltf, primitive, part);
  if (uvs == MeshUvs::if_any || uvs == MeshUvs::with_tangents) read_tangents(gltf, primitive, part);
  read_colors(gltf, primitive, part);
  bool is_inside_out = false;
  if (index.node) {
    std::optional<Transform> instance;
    if (index.instance) {
      const std::vector<Transform> all = read_instances(gltf, *index.node);
      if (*index.instance >= all.size())
        throw bad_file(gltf.path, "has no such instance", "below " + std::to_string(all.size()),
                       '"' + name + '"');
      instance = all[*index.instance];
    }
    is_inside_out = pose(gltf, *index.node, instance, primitive, state, place, part);
    check_positions(gltf, positions->second, part.positions);
  }
  TriangleList(gltf, primitive, place).read(part);
  if (is_inside_out)
    for (auto& [a, b, c] : part.triangles) std::swap(b, c);
  if (part.triangles.empty())
    fail_at(gltf.path, place, "has no triangles", "at least three corners", "fewer");
  return part;
}

GltfPart read_gltf_part(const std::string& path, const std::string& part, MeshUvs uvs,
                        const std::optional<AnimationTime>& pose) {
  const std::shared_ptr<const GltfModel> gltf = load_gltf(path);
  if (!pose) return read_gltf_part(*gltf, part, uvs);
  const GltfState state = load_animation(gltf, find_animation(*gltf, pose->animation))->at(pose->seconds);
  return read_gltf_part(*gltf, part, uvs, &state);
}

std::string gltf_contents(const std::string& path) {
  return load_gltf(path)->contents;
}

}  // namespace opaline
