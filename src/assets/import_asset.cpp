// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/import_asset.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "assets/asset_scene.h"
#include "core/lower_case.h"
#include "opaline/error.h"

namespace opaline {
namespace {

enum class AssetKind { none, gltf, obj, mesh };

AssetKind kind_of(const std::string& path) {
  const std::string extension = in_lower_case(std::filesystem::path(path).extension().string());
  if (extension == ".glb" || extension == ".gltf") return AssetKind::gltf;
  if (extension == ".obj") return AssetKind::obj;
  const bool is_mesh = extension == ".ply" || extension == ".stl" || extension == ".off";
  return is_mesh ? AssetKind::mesh : AssetKind::none;
}

AssetScene import_scene(const std::string& path, const std::string& mesh_path, const std::string& animation) {
  const AssetKind kind = kind_of(path);
  if (!animation.empty() && kind != AssetKind::gltf)
    throw bad_file(path, "has no animations", "a glTF file with animations");
  switch (kind) {
    case AssetKind::gltf:
      return import_gltf(path, mesh_path, animation);
    case AssetKind::mesh:
      return import_mesh(path, mesh_path);
    default:
      return import_obj(path, mesh_path);
  }
}

std::string summary_of(const AssetScene& scene, bool own_camera, bool own_lights) {
  std::string text = fmt::format("{} translucent {}, {} camera, {} lights", scene.media.size(),
                                 scene.media.size() == 1 ? "medium" : "media", own_camera ? "its" : "default",
                                 own_lights ? "its" : "default");
  constexpr std::size_t kMostNamed = 4;
  std::vector<std::string> lost = scene.not_carried;
  std::erase_if(lost, [&](const std::string& what) { return scene.warned.contains(what); });
  for (std::size_t i = 0; i < std::min(kMostNamed, lost.size()); ++i)
    text += (i == 0 ? "; not imported: " : ", ") + lost[i];
  if (lost.size() > kMostNamed) text += fmt::format(" and {} more", lost.size() - kMostNamed);
  return text;
}

/// Checks the extent against a scene file's limits, with a margin for a camera and lights.
void check_extent(const std::string& path, const AssetScene& scene) {
  constexpr double limit = 1e15;
  const double farthest = max_component(component_max(scene.center, -scene.center)) + scene.radius;
  if (!(farthest < limit))
    throw bad_file(path, "extends too far from the origin", fmt::format("coordinates below {:.0e}", limit),
                   fmt::format("{:.3g}", farthest));
}

/// in    name: of the surface's medium
void replace_surface(const SurfaceTranslation& surface, const std::string& name, const AssetScene& scene,
                     Json& shape) {
  Json bare = Json::object();
  for (const char* key :
       {"name", "file", "part", "animation", "animation_time", "transform", "normals", "vertex_colors"})
    if (shape.contains(key)) bare[key] = shape[key];
  if (shape.contains("opacity") && surface.medium.is_null() && !surface.keys.contains("emission"))
    bare["opacity"] = shape["opacity"];
  shape = std::move(bare);
  if (scene.has_vertex_colors) shape["vertex_colors"] = false;
  if (surface.medium.is_null())
    shape["reflectance"] = triple_json(surface.reflectance);
  else
    shape["medium"] = name;
  for (const auto& [key, value] : surface.keys.items()) shape[key] = value;
  if (!surface.medium.is_null() && scene.is_one_mesh && scene.shapes.size() > 1) shape["group"] = name;
}

/// Replaces the material of each shape by that of its name in the file.
/// Returns false if no shape has such a material.
bool replace_by_name(AssetScene& scene, const std::string& file, const AssetPlace& asset) {
  std::map<std::string, SurfaceTranslation> surfaces;
  const std::set<std::string> names = materialx_names(file);
  for (const std::string& name : scene.material_names)
    if (names.contains(name) && !surfaces.contains(name)) {
      scene.translated.push_back(fmt::format("material '{}' -> {}#{}", name, file, name));
      surfaces[name] = translate_materialx(file + '#' + name, asset, scene);
    }
  if (surfaces.empty()) return false;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const auto found = surfaces.find(scene.material_names[i]);
    if (found != surfaces.end())
      replace_surface(found->second, found->first, scene, scene.shapes[i]);
    else
      scene.warn(file,
                 fmt::format("has no material '{}': it stays as in the asset", scene.material_names[i]));
  }
  Json media = Json::object();
  for (const Json& shape : scene.shapes)
    if (const std::string name = shape.value("medium", ""); !name.empty()) {
      const auto found = surfaces.find(name);
      media[name] = found != surfaces.end() ? found->second.medium : scene.media[name];
    }
  scene.media = std::move(media);
  return true;
}

void replace_materials(AssetScene& scene, const std::string& material, const AssetPlace& asset) {
  if (material.find('#') == material.npos && replace_by_name(scene, material, asset)) return;
  scene.translated.push_back("all materials of the asset -> " + in_quotes(material));
  const SurfaceTranslation surface = translate_materialx(material, asset, scene);
  constexpr const char* name = "material";
  scene.media = Json::object();
  if (!surface.medium.is_null()) scene.media[name] = surface.medium;
  for (Json& shape : scene.shapes) replace_surface(surface, name, scene, shape);
}

}  // namespace

bool is_asset_name(const std::string& path) {
  return kind_of(path) != AssetKind::none;
}

ImportedAsset import_asset(const std::string& path, const std::string& mesh_path, const std::string& material,
                           const std::string& animation) {
  AssetScene scene = import_scene(path, mesh_path, animation);
  const bool own_camera = !scene.camera.is_null(), own_lights = scene.center_irradiance > 0;
  check_extent(path, scene);
  if (!material.empty()) replace_materials(scene, material, {path, mesh_path});
  add_defaults(scene);
  try {
    std::string text = scene_text(scene, std::filesystem::path(path).filename().string());
    std::string summary = summary_of(scene, own_camera, own_lights);
    return {std::move(text),
            std::move(scene.translated),
            std::move(scene.not_carried),
            std::move(scene.warnings),
            std::move(summary),
            scene.bytes,
            std::move(scene.textures),
            {!own_camera, !own_lights, scene.center, scene.radius, scene.extent, scene.media.empty()}};
  } catch (const Json::exception&) {
    throw bad_file(path, "contains a name that is not UTF-8", "names in UTF-8");
  }
}

}  // namespace opaline
