// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes of a glTF scene as shapes, camera and lights.
#include <fmt/format.h>

#include <array>
#include <map>

#include "asset_files/gltf_accessor.h"
#include "asset_files/gltf_animation.h"
#include "asset_files/gltf_instances.h"
#include "asset_files/gltf_uv_set.h"
#include "assets/asset_scene.h"
#include "assets/gltf_material.h"
#include "assets/gltf_motion.h"
#include "assets/gltf_view.h"
#include "geometry/formats/gltf_pose.h"
#include "geometry/formats/gltf_triangles.h"

namespace opaline {
namespace {

constexpr std::size_t kMostMoving = 1000;  // instances of a moving node: each has a mesh of its own

bool is_finite(const Transform& t) {
  return is_finite(t.x) && is_finite(t.y) && is_finite(t.z) && is_finite(t.translation);
}

/// A node of the scene with its transform; for an instanced mesh, the instance.
struct PlacedNode {
  std::size_t index, instance, instances;
  Transform to_world, to_node{};
};

/// Walks down from the scene's roots.
class NodeWalk {
 public:
  explicit NodeWalk(const GltfModel& gltf) : gltf_(gltf), is_met_(gltf.nodes.size()) {}

  /// Nodes with content, in the order of the file, parents first.
  std::vector<PlacedNode> run(const std::vector<std::uint32_t>& roots) {
    push(roots, 1);
    std::vector<PlacedNode> placed;
    std::vector<Transform> above{Transform{}};  // transforms of the nodes from the world to the current one
    while (!open_.empty()) {
      const auto [index, depth] = open_.back();
      open_.pop_back();
      above.resize(depth);
      above.push_back(compose(above.back(), gltf_.nodes[index].to_parent()));
      if (!is_finite(above.back()))
        fail_at(gltf_.path, record_name("nodes", index), "has a position that is not finite");
      const GltfNode& node = gltf_.nodes[index];
      if (node.mesh != kNoRecord || node.camera != kNoRecord || node.light != kNoRecord)
        placed.push_back({index, 0, 1, above.back()});
      push(node.children, depth + 1);
    }
    return placed;
  }

 private:
  struct OpenNode {
    std::uint32_t index, depth;
  };

  void push(const std::vector<std::uint32_t>& nodes, std::uint32_t depth) {
    for (std::size_t i = nodes.size(); i-- > 0;) {
      if (is_met_[nodes[i]])
        fail_at(gltf_.path, record_name("nodes", nodes[i]), "has two parents, or is its own",
                "a tree of nodes");
      is_met_[nodes[i]] = true;
      open_.push_back({nodes[i], depth});
    }
  }

  const GltfModel& gltf_;
  std::vector<bool> is_met_;
  std::vector<OpenNode> open_;
};

class GltfImporter {
 public:
  /// animation: name or index; empty: the first readable one with an effect
  GltfImporter(const GltfModel& gltf, std::string mesh_path, const std::string& animation)
      : gltf_(gltf), mesh_path_(std::move(mesh_path)), animation_(animation) {}

  AssetScene run() {
    scene_.mm_per_unit = 1000;
    scene_.translated.push_back("lengths in metres -> mm_per_unit 1000");
    for (const std::string& warning : gltf_.warnings) scene_.warn(gltf_.path, warning);
    choose_animation();
    const std::vector<PlacedNode> nodes = NodeWalk(gltf_).run(roots());
    for (const PlacedNode& node : nodes) add_meshes(node);
    if (scene_.shapes.empty())
      throw bad_file(gltf_.path, "contains no visible mesh",
                     "a scene with a node that has a mesh of triangles",
                     scene_.warnings.empty() ? "" : scene_.not_carried.back());
    enclose_parts();
    for (const PlacedNode& node : nodes) {
      const bool had_camera = !scene_.camera.is_null();
      add_camera(gltf_, node.index, node.to_world, scene_);
      if (!had_camera && !scene_.camera.is_null() && motion_) motion_->add_to(scene_.camera, node.index);
    }
    for (const PlacedNode& node : nodes) {
      const std::size_t lights = scene_.lights.size();
      add_light(gltf_, node.index, node.to_world, light_names_, scene_);
      if (scene_.lights.size() > lights && motion_) motion_->add_to(scene_.lights.back(), node.index);
    }
    tell_losses();
    return std::move(scene_);
  }

 private:
  struct PlacedPart {
    std::string part;
    Transform to_world;
    bool is_moving;
  };

  void choose_animation() {
    if (!animation_.empty()) {
      motion_.emplace(gltf_, find_animation(gltf_, animation_));
      if (motion_->is_empty())
        throw bad_file(gltf_.path, "its animation moves nothing", "another animation", in_quotes(animation_));
    }
    for (std::size_t i = 0; i < gltf_.count("animations") && !motion_; ++i) try {
        motion_.emplace(gltf_, i);
        if (motion_->is_empty()) motion_.reset();
      } catch (const Error& failure) {
        scene_.warn(gltf_.path, fmt::format("animation '{}': ignored, it cannot be read: {}",
                                            animation_name(gltf_, i), failure.what()));
      }
    if (!motion_) return;
    scene_.translated.push_back("animation " + in_quotes(motion_->name()) + " -> " + motion_->frames_text());
    for (std::size_t i = 0; i < gltf_.count("animations"); ++i)
      if (i != motion_->index())
        scene_.not_carried.push_back("animation " + in_quotes(animation_name(gltf_, i)) +
                                     ": not imported; `opaline import --animation` chooses one");
  }

  /// Roots of the default scene, or the first; without scenes all nodes without a parent.
  std::vector<std::uint32_t> roots() {
    if (!gltf_.scenes.empty()) {
      const std::size_t chosen = gltf_.scene == kNoRecord ? 0 : gltf_.scene;
      if (gltf_.scenes.size() > 1)
        scene_.not_carried.push_back(fmt::format("{} of its {} scenes: uses {}", gltf_.scenes.size() - 1,
                                                 gltf_.scenes.size(), record_name("scenes", chosen)));
      return gltf_.scenes[chosen];
    }
    std::vector<std::uint32_t> all;
    for (std::size_t i = 0; i < gltf_.nodes.size(); ++i)
      if (gltf_.nodes[i].parent == kNoRecord) all.push_back(std::uint32_t(i));
    return all;
  }

  void add_meshes(const PlacedNode& placed) {
    const GltfNode& node = gltf_.nodes[placed.index];
    if (node.mesh == kNoRecord) return;
    const std::string label =
        node.name.empty() ? record_name("nodes", placed.index) : "node " + in_quotes(node.name);
    tell_mesh_losses(node.mesh);
    const std::vector<Transform> all = read_instances(gltf_, placed.index);
    if (all.size() > kMostMoving && motion_ && motion_->moves(std::uint32_t(placed.index)))
      scene_.warn(gltf_.path, fmt::format("{}: its {} instances stand still; at most {} can move", label,
                                          all.size(), kMostMoving));
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t p = 0; p < gltf_.meshes[node.mesh].primitives.size(); ++p)
        if (has_triangles(node.mesh, p))
          add_shape({placed.index, i, all.size(), compose(placed.to_world, all[i]), all[i]}, p, label);
  }

  /// Reports a primitive without triangles once.
  bool has_triangles(std::size_t mesh, std::size_t p) const {
    const GltfPrimitive& primitive = gltf_.meshes[mesh].primitives[p];
    return primitive.mode >= kGltfTriangles && primitive.mode <= kGltfTriangleFan &&
           primitive.attributes.contains("POSITION");
  }

  void add_shape(const PlacedNode& placed, std::size_t p, const std::string& label) {
    const GltfNode& node = gltf_.nodes[placed.index];
    const GltfMesh& mesh = gltf_.meshes[node.mesh];
    const GltfPrimitive& primitive = mesh.primitives[p];
    const bool skinned = is_skinned(gltf_, placed.index, primitive),
               is_moving = is_animated(placed, primitive);
    const Transform t = skinned || is_moving ? Transform{} : placed.to_world,
                    stands = is_moving && !skinned
                                 ? compose(motion_->first_place(placed.index), placed.to_node)
                                 : t;
    if (!(std::abs(dot(normalized(stands.x), cross(normalized(stands.y), normalized(stands.z)))) > 1e-12))
      return scene_.warn(gltf_.path, label + ": its transform is singular; the mesh is ignored" +
                                         zero_scale_text(placed.index));
    std::string part = fmt::format("{}/{}", node.mesh, p);
    if (is_moving || is_posed(gltf_, placed.index, primitive)) part += fmt::format("/{}", placed.index);
    if (is_moving && gltf_.instances.contains(placed.index)) part += fmt::format("/{}", placed.instance);
    const std::string name = shape_names_.take(node.name.empty() ? mesh.name : node.name, "shape");
    Json shape{{"name", name}, {"file", mesh_path_}, {"part", part}};
    if (is_moving) motion_->add_to_shape(shape);
    if (t != Transform{}) {
      Json rows = Json::array();
      for (std::size_t i = 0; i < 3; ++i) rows.push_back({t.x[i], t.y[i], t.z[i], t.translation[i]});
      shape["transform"] = Json::array({{{"matrix", rows}}});
    }
    const bool is_faceted = !primitive.attributes.contains("NORMAL");
    if (is_faceted) shape["normals"] = "faceted";
    if (primitive.attributes.contains("COLOR_0")) shape["vertex_colors"] = scene_.has_vertex_colors = true;
    const std::size_t uv_set = uv_set_of(gltf_, primitive);
    const MaterialUse use{primitive.material, uv_set, primitive.attributes.contains(uv_attribute(uv_set)),
                          primitive.attributes.contains("TANGENT") && primitive.attributes.contains("NORMAL"),
                          mesh_path_};
    add_surface(shape, use, placed, mesh.primitives.size() > 1);
    scene_.shapes.push_back(std::move(shape));
    const bool has_material = primitive.material < gltf_.count("materials");
    scene_.material_names.push_back(has_material ? gltf_.record("materials", primitive.material).text("name")
                                                 : "");
    parts_.push_back({part, t, is_moving});
    scene_.translated.push_back(fmt::format(
        "{}, part {} of the asset -> shape {}{}{}", label, part, in_quotes(name),
        is_moving ? ", animated"
        : skinned ? ", by its skin, joints at rest"
                  : "",
        is_faceted ? ", faceted: it has no normals (\"normals\": \"smooth\" computes them)" : ""));
  }

  bool is_animated(const PlacedNode& placed, const GltfPrimitive& primitive) const {
    const auto node = std::uint32_t(placed.index);
    if (!motion_ || placed.instances > kMostMoving) return false;
    if (!primitive.targets.empty() && motion_->changes_weights(node)) return true;
    return is_skinned(gltf_, node, primitive) ? motion_->moves_skin(gltf_.nodes[node].skin)
                                              : motion_->moves(node);
  }

  /// Primitives of one node with the same medium are one body.
  void add_surface(Json& shape, const MaterialUse& use, const PlacedNode& placed, bool has_siblings) {
    const Surface& surface = surface_of(use);
    if (surface.medium.empty()) shape["reflectance"] = triple_json(surface.reflectance);
    for (const auto& [key, value] : surface.keys.items()) shape[key] = value;
    if (surface.medium.empty()) return;
    shape["medium"] = surface.medium;
    if (!has_siblings) return;
    shape["group"] = fmt::format("{} of node {}", surface.medium, placed.index);
    if (placed.instance > 0)
      shape["group"] =
          fmt::format("{} of node {}, instance {}", surface.medium, placed.index, placed.instance);
  }

  struct Surface {
    std::string medium;  ///< its name; empty: opaque
    Vec3d reflectance;
    Json keys;
  };

  const Surface& surface_of(const MaterialUse& use) {
    const std::tuple key{use.index, use.uv_set, use.has_uvs, use.has_tangents};
    const auto known = surfaces_.find(key);
    if (known != surfaces_.end()) return known->second;
    SurfaceTranslation translation = translate_material(gltf_, use, scene_);
    Surface surface{"", translation.reflectance, std::move(translation.keys)};
    if (!translation.medium.is_null()) {
      surface.medium = medium_names_.take(gltf_.record("materials", use.index).text("name"), "medium");
      scene_.media[surface.medium] = std::move(translation.medium);
    }
    return surfaces_[key] = surface;
  }

  void tell_mesh_losses(std::size_t index) {
    if (!told_meshes_.insert(index).second) return;
    const GltfMesh& mesh = gltf_.meshes[index];
    const std::string label =
        mesh.name.empty() ? record_name("meshes", index) : "mesh " + in_quotes(mesh.name);
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      const GltfPrimitive& primitive = mesh.primitives[p];
      const std::string place = label + ' ' + record_name("primitives", p);
      if (!has_triangles(index, p)) scene_.not_carried.push_back(place + ": it has no triangles");
      if (primitive.attributes.contains("COLOR_0"))
        scene_.translated.push_back(place + ": its vertex colours multiply the base colour");
    }
  }

  /// Names the nearest node with a zero in its scale, from this one up: "; the scale of node 'arm' is [1, 0,
  /// 1]".
  std::string zero_scale_text(std::size_t index) const {
    for (auto at = std::uint32_t(index); at != kNoRecord; at = gltf_.nodes[at].parent) {
      const Transform t = gltf_.nodes[at].to_parent();
      const Vec3d scale{length(t.x), length(t.y), length(t.z)};
      if (scale.x * scale.y * scale.z > 0) continue;
      const std::string& name = gltf_.nodes[at].name;
      return fmt::format("; the scale of {} is {}",
                         name.empty() ? record_name("nodes", at) : "node " + in_quotes(name),
                         short_triple(scale));
    }
    return {};
  }

  /// in    poses: of moving parts, in equal steps of time
  template <class Visit>
  void for_each_point(int poses, const Visit& visit) {
    for (const PlacedPart& placed : parts_) {
      const auto visit_all = [&](const std::vector<Vec3d>& points) {
        for (const Vec3d& point : points) visit(transform_point(placed.to_world, point));
      };
      if (!placed.is_moving) {
        std::vector<Vec3d>& points = standing_points_[placed.part];
        if (points.empty()) points = points_of(placed.part, nullptr);
        visit_all(points);
      }
      for (int i = 0; placed.is_moving && i < poses; ++i) {
        const GltfState state = motion_->at(double(i) / std::max(poses - 1, 1));
        visit_all(points_of(placed.part, &state));
      }
    }
  }

  /// The vertices of triangles.
  std::vector<Vec3d> points_of(const std::string& part_name, const GltfState* state) const {
    const GltfPart part = read_gltf_part(gltf_, part_name, MeshUvs::unread, state);
    std::vector<char> is_used(part.positions.size());
    for (const auto& triangle : part.triangles)
      for (const std::uint32_t v : triangle) is_used[v] = 1;
    std::vector<Vec3d> points;
    points.reserve(part.positions.size());
    for (std::size_t v = 0; v < is_used.size(); ++v)
      if (is_used[v] != 0) points.push_back(part.positions[v]);
    return points;
  }

  /// The extent belongs to the first pose; the default camera frames the motion.
  void enclose_parts() {
    constexpr int kPoses = 9;
    enclose(scene_, [&](const auto& visit) { for_each_point(1, visit); });
    if (!motion_) return;
    const double extent = scene_.extent;
    enclose(scene_, [&](const auto& visit) { for_each_point(kPoses, visit); });
    scene_.extent = extent;
  }

  void tell_losses() {
    constexpr std::array<std::string_view, 7> read{"KHR_lights_punctual",       "KHR_mesh_quantization",
                                                   "EXT_texture_webp",          "KHR_texture_transform",
                                                   "EXT_mesh_gpu_instancing",   "EXT_meshopt_compression",
                                                   "KHR_draco_mesh_compression"};
    const std::set<std::string> required(gltf_.extensions_required.begin(), gltf_.extensions_required.end());
    std::set<std::string> used = required;
    used.insert(gltf_.extensions_used.begin(), gltf_.extensions_used.end());
    for (const std::string& name : used) {
      if (name.starts_with("KHR_materials_") || std::ranges::find(read, name) != read.end()) continue;
      if (required.contains(name))
        scene_.warn(gltf_.path,
                    "extension " + in_quotes(name) + ": required by the asset, but not supported");
      else
        scene_.not_carried.push_back("extension " + in_quotes(name));
    }
  }

  const GltfModel& gltf_;
  std::string mesh_path_;
  const std::string& animation_;
  AssetScene scene_;
  std::optional<GltfMotion> motion_;
  UniqueNames shape_names_, medium_names_, light_names_;
  std::map<std::tuple<std::uint32_t, std::size_t, bool, bool>, Surface>
      surfaces_;  // by material, its set of UVs, and presence of UVs and tangents
  std::set<std::size_t> told_meshes_;
  std::vector<PlacedPart> parts_;
  std::map<std::string, std::vector<Vec3d>> standing_points_;  // by part
};

}  // namespace

AssetScene import_gltf(const std::string& path, const std::string& mesh_path, const std::string& animation) {
  const std::shared_ptr<const GltfModel> gltf = load_gltf(path);
  AssetScene scene = GltfImporter(*gltf, mesh_path, animation).run();
  scene.bytes = gltf->record_bytes;
  return scene;
}

}  // namespace opaline
