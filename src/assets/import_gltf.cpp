// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes of a glTF scene as shapes, camera and lights.
#include <fmt/format.h>

#include <array>
#include <map>

#include "assets/asset_scene.h"
#include "assets/gltf_material.h"
#include "assets/gltf_triangles.h"
#include "assets/gltf_view.h"

namespace opaline {
namespace {

/// First `first`, then `second`.
Transform compose(const Transform& second, const Transform& first) {
  const auto linear = [&](const Vec3d& v) { return second.x * v.x + second.y * v.y + second.z * v.z; };
  return {linear(first.x), linear(first.y), linear(first.z), transform_point(second, first.translation)};
}

Transform rotation(double x, double y, double z, double w) {
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
          {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
          {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
          {}};
}

bool is_finite(const Transform& t) {
  return is_finite(t.x) && is_finite(t.y) && is_finite(t.z) && is_finite(t.translation);
}

/// A node that belongs to the scene, with its place in the world.
struct PlacedNode {
  std::size_t index;
  Transform to_world;
};

/// Walks down from the scene's roots.
class NodeWalk {
 public:
  explicit NodeWalk(const GltfModel& gltf) : gltf_(gltf), is_met_(gltf.model.nodes.size()) {}

  /// In the order of the file, parents first.
  std::vector<PlacedNode> run(const std::vector<int>& roots) {
    push(roots, {});
    std::vector<PlacedNode> placed;
    while (!open_.empty()) {
      const PlacedNode next = open_.back();
      open_.pop_back();
      placed.push_back(next);
      push(gltf_.model.nodes[next.index].children, next.to_world);
    }
    return placed;
  }

 private:
  void push(const std::vector<int>& nodes, const Transform& parent) {
    for (std::size_t i = nodes.size(); i-- > 0;) {
      const auto node = std::size_t(nodes[i]);
      if (is_met_[node])
        fail_at(gltf_.path, record_name("nodes", node), "has two parents, or is its own", "a tree of nodes");
      is_met_[node] = true;
      const Transform to_world = compose(parent, local(node));
      if (!is_finite(to_world))
        fail_at(gltf_.path, record_name("nodes", node), "is placed beyond all numbers");
      open_.push_back({node, to_world});
    }
  }

  Transform local(std::size_t index) const {
    const tinygltf::Node& node = gltf_.model.nodes[index];
    check_length(index, "matrix", node.matrix, 16);
    check_length(index, "translation", node.translation, 3);
    check_length(index, "rotation", node.rotation, 4);
    check_length(index, "scale", node.scale, 3);
    if (const auto& m = node.matrix; !m.empty())
      return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
    Transform t;
    if (const auto& q = node.rotation; !q.empty()) {
      const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      if (!(norm > 0))
        fail_at(gltf_.path, record_name("nodes", index) + ".rotation", "is no rotation", "not 0");
      t = rotation(q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm);
    }
    if (const auto& s = node.scale; !s.empty()) t.x *= s[0], t.y *= s[1], t.z *= s[2];
    if (const auto& p = node.translation; !p.empty()) t.translation = {p[0], p[1], p[2]};
    return t;
  }

  void check_length(std::size_t node, const char* key, const std::vector<double>& numbers,
                    std::size_t size) const {
    if (!numbers.empty() && numbers.size() != size)
      fail_at(gltf_.path, record_name("nodes", node) + '.' + key, "is of the wrong length",
              std::to_string(size) + " numbers", std::to_string(numbers.size()));
  }

  const GltfModel& gltf_;
  std::vector<bool> is_met_;
  std::vector<PlacedNode> open_;
};

class GltfImporter {
 public:
  GltfImporter(const GltfModel& gltf, std::string mesh_path)
      : gltf_(gltf), mesh_path_(std::move(mesh_path)) {}

  AssetScene run() {
    scene_.mm_per_unit = 1000;
    scene_.translated.push_back("lengths in metres -> mm_per_unit 1000");
    const std::vector<PlacedNode> nodes = NodeWalk(gltf_).run(roots());
    for (const PlacedNode& node : nodes) add_meshes(node);
    if (scene_.shapes.empty())
      throw bad_file(gltf_.path, "shows nothing", "a scene with a node that has a mesh of triangles");
    enclose(scene_, [&](const auto& visit) { for_each_point(visit); });
    for (const PlacedNode& node : nodes) add_camera(gltf_, node.index, node.to_world, scene_);
    for (const PlacedNode& node : nodes) add_light(gltf_, node.index, node.to_world, light_names_, scene_);
    tell_losses();
    return std::move(scene_);
  }

 private:
  struct PlacedPart {
    std::string part;
    Transform to_world;
  };

  /// Of the default scene, or the first; without scenes all nodes that are no other's child.
  std::vector<int> roots() {
    const tinygltf::Model& model = gltf_.model;
    if (!model.scenes.empty()) {
      const std::size_t chosen = model.defaultScene < 0 ? 0 : std::size_t(model.defaultScene);
      if (model.scenes.size() > 1)
        scene_.not_carried.push_back(fmt::format("{} of its {} scenes: {} is taken", model.scenes.size() - 1,
                                                 model.scenes.size(), record_name("scenes", chosen)));
      return model.scenes[chosen].nodes;
    }
    std::vector<bool> is_child(model.nodes.size());
    for (const tinygltf::Node& node : model.nodes)
      for (const int child : node.children) is_child[std::size_t(child)] = true;
    std::vector<int> all;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
      if (!is_child[i]) all.push_back(int(i));
    return all;
  }

  void add_meshes(const PlacedNode& placed) {
    const tinygltf::Node& node = gltf_.model.nodes[placed.index];
    if (node.mesh < 0) return;
    const tinygltf::Mesh& mesh = gltf_.model.meshes[std::size_t(node.mesh)];
    const std::string label =
        node.name.empty() ? record_name("nodes", placed.index) : "node " + in_quotes(node.name);
    const Transform& t = placed.to_world;
    if (!(std::abs(dot(normalized(t.x), cross(normalized(t.y), normalized(t.z)))) > 1e-12)) {
      scene_.not_carried.push_back(label + ": its transform flattens the mesh");
      return;
    }
    tell_mesh_losses(std::size_t(node.mesh));
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p)
      if (has_triangles(std::size_t(node.mesh), p)) add_shape(placed, p, label);
  }

  /// error none: what has no triangles is said once
  bool has_triangles(std::size_t mesh, std::size_t p) const {
    const tinygltf::Primitive& primitive = gltf_.model.meshes[mesh].primitives[p];
    return primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN &&
           primitive.attributes.contains("POSITION");
  }

  void add_shape(const PlacedNode& placed, std::size_t p, const std::string& label) {
    const tinygltf::Node& node = gltf_.model.nodes[placed.index];
    const tinygltf::Mesh& mesh = gltf_.model.meshes[std::size_t(node.mesh)];
    const tinygltf::Primitive& primitive = mesh.primitives[p];
    const std::string part = fmt::format("{}/{}", node.mesh, p);
    const std::string name = shape_names_.take(node.name.empty() ? mesh.name : node.name, "shape");
    Json shape{{"name", name}, {"file", mesh_path_}, {"part", part}};
    const Transform& t = placed.to_world;
    if (t != Transform{}) {
      Json rows = Json::array();
      for (std::size_t i = 0; i < 3; ++i) rows.push_back({t.x[i], t.y[i], t.z[i], t.translation[i]});
      shape["transform"] = Json::array({{{"matrix", rows}}});
    }
    const bool is_faceted = !primitive.attributes.contains("NORMAL");
    if (is_faceted) shape["normals"] = "faceted";
    if (primitive.attributes.contains("COLOR_0")) shape["vertex_colors"] = scene_.has_vertex_colors = true;
    const MaterialUse use{primitive.material, primitive.attributes.contains("TEXCOORD_0"),
                          primitive.attributes.contains("TANGENT") && primitive.attributes.contains("NORMAL"),
                          mesh_path_};
    add_surface(shape, use, placed.index, mesh.primitives.size() > 1);
    scene_.shapes.push_back(std::move(shape));
    parts_.push_back({part, t});
    scene_.translated.push_back(
        fmt::format("{}, part {} of the asset -> shape {}{}", label, part, in_quotes(name),
                    is_faceted ? ", faceted: it has no normals (\"normals\": \"smooth\" makes some)" : ""));
  }

  /// Primitives of one node that share a medium are one body.
  void add_surface(Json& shape, const MaterialUse& use, std::size_t node, bool has_siblings) {
    const Surface& surface = surface_of(use);
    if (surface.medium.empty()) shape["reflectance"] = triple_json(surface.reflectance);
    for (const auto& [key, value] : surface.keys.items()) shape[key] = value;
    if (surface.medium.empty()) return;
    shape["medium"] = surface.medium;
    if (!has_siblings) return;
    shape["group"] = fmt::format("{} of node {}", surface.medium, node);
  }

  struct Surface {
    std::string medium;  ///< its name; empty: opaque
    Vec3d reflectance;
    Json keys;
  };

  const Surface& surface_of(const MaterialUse& use) {
    const std::tuple key{use.index, use.has_uvs, use.has_tangents};
    const auto known = surfaces_.find(key);
    if (known != surfaces_.end()) return known->second;
    SurfaceTranslation translation = translate_material(gltf_, use, scene_);
    Surface surface{"", translation.reflectance, std::move(translation.keys)};
    if (!translation.medium.is_null()) {
      surface.medium = medium_names_.take(gltf_.model.materials[std::size_t(use.index)].name, "medium");
      scene_.media[surface.medium] = std::move(translation.medium);
    }
    return surfaces_[key] = surface;
  }

  void tell_mesh_losses(std::size_t index) {
    if (!told_meshes_.insert(index).second) return;
    const tinygltf::Mesh& mesh = gltf_.model.meshes[index];
    const std::string label =
        mesh.name.empty() ? record_name("meshes", index) : "mesh " + in_quotes(mesh.name);
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = mesh.primitives[p];
      const std::string place = label + ' ' + record_name("primitives", p);
      if (!has_triangles(index, p)) scene_.not_carried.push_back(place + ": it has no triangles");
      if (!primitive.targets.empty()) scene_.not_carried.push_back(place + ": its morph targets");
      if (primitive.attributes.contains("COLOR_0"))
        scene_.translated.push_back(place + ": its vertex colours multiply the base colour");
    }
  }

  template <class Visit>
  void for_each_point(const Visit& visit) const {
    for (const PlacedPart& placed : parts_) {
      const GltfPart part = read_gltf_part(gltf_, placed.part);
      for (const auto& triangle : part.triangles)
        for (const std::uint32_t v : triangle) visit(transform_point(placed.to_world, part.positions[v]));
    }
  }

  void tell_losses() {
    const auto count = [&](const char* list) {
      const auto found = gltf_.counts.find(list);
      return found == gltf_.counts.end() ? std::size_t(0) : found->second;
    };
    if (count("animations") > 0)
      scene_.not_carried.push_back(
          fmt::format("animations ({}): the asset stands still", count("animations")));
    if (count("skins") > 0)
      scene_.not_carried.push_back(
          fmt::format("skins ({}): meshes stand as they were modelled", count("skins")));
    constexpr std::array<std::string_view, 3> read{"KHR_lights_punctual", "KHR_mesh_quantization",
                                                   "KHR_texture_transform"};
    const tinygltf::Model& model = gltf_.model;
    const std::set<std::string> required(model.extensionsRequired.begin(), model.extensionsRequired.end());
    std::set<std::string> used = required;
    used.insert(model.extensionsUsed.begin(), model.extensionsUsed.end());
    for (const std::string& name : used)
      if (!name.starts_with("KHR_materials_") && std::ranges::find(read, name) == read.end())
        scene_.not_carried.push_back("extension " + in_quotes(name) +
                                     (required.contains(name) ? ", which the asset requires" : ""));
  }

  const GltfModel& gltf_;
  std::string mesh_path_;
  AssetScene scene_;
  UniqueNames shape_names_, medium_names_, light_names_;
  std::map<std::tuple<int, bool, bool>, Surface>
      surfaces_;  // by material, and whether there are UVs and tangents
  std::set<std::size_t> told_meshes_;
  std::vector<PlacedPart> parts_;
};

}  // namespace

AssetScene import_gltf(const std::string& path, const std::string& mesh_path) {
  const std::shared_ptr<const GltfModel> gltf = load_gltf(path);
  return GltfImporter(*gltf, mesh_path).run();
}

}  // namespace opaline
