// SPDX-License-Identifier: GPL-3.0-or-later
// Intermediate scene between an asset and a scene file.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "asset_files/asset_file.h"
#include "assets/import_asset.h"
#include "opaline/vec3.h"

namespace opaline {

using Json = nlohmann::ordered_json;

/// Lengths in the asset's unit. Each Json as in the scene file; null or empty: missing in the asset.
struct AssetScene {
  double mm_per_unit = 1;
  Json media = Json::object(), shapes = Json::array(), lights = Json::array(), camera, film = Json::object();
  std::vector<std::string> material_names;  ///< a name for each shape, or empty
  Vec3d center;                             ///< center of the box around the shapes
  double radius = 1;                        ///< distance from there to the farthest vertex
  double extent = 0;                        ///< largest side of the box
  double backdrop = 0;                      ///< grey behind the default lights; 0: none
  double center_irradiance = 0;             ///< irradiance from its lights at the center, facing them
  bool is_one_mesh = false;                 ///< true if its shapes are parts of one body
  bool has_vertex_colors = false;
  std::vector<std::string> translated, not_carried;
  std::vector<std::string> warnings;                         ///< changes of the image
  std::size_t bytes = 0;                                     ///< as ImportedAsset's
  std::vector<std::shared_ptr<const TextureFile>> textures;  ///< as ImportedAsset's
  std::map<std::string, std::set<std::string>> warned;       ///< places of each warning, by its text

  /// Adds a warning of a lost statement or value of a file that changes the image, once.
  void warn(const std::string& place, const std::string& what) {
    if (!warned[what].insert(place).second) return;
    not_carried.push_back(what);
    warnings.push_back(place + ": " + what);
  }
};

/// Result of a shape's material.
struct SurfaceTranslation {
  Json medium;                 ///< as in a scene file; null: opaque
  Json keys = Json::object();  ///< other keys of the shape; a reflectance among them replaces the next
  Vec3d reflectance{1, 1, 1};
};

/// Path of an asset, and its name in the scene file.
struct AssetPlace {
  std::string path, mesh_path;
};

/// Translates a surface of a MaterialX file.
/// in    file_and_name: "skin.mtlx", or "skin.mtlx#name" of a surface or material in it; scene: provides the
///       unit of lengths, and receives warnings
/// error Error{bad_input} naming the file: not XML, no such surface, a value of the wrong type
SurfaceTranslation translate_materialx(const std::string& file_and_name, const AssetPlace& asset,
                                       AssetScene& scene);

/// Materials of a MaterialX file with such a surface, by name.
/// error as translate_materialx
std::set<std::string> materialx_names(const std::string& file);

AssetScene import_gltf(const std::string& path, const std::string& mesh_path, const std::string& animation);
AssetScene import_obj(const std::string& path, const std::string& mesh_path);
/// PLY, STL and OFF.
AssetScene import_mesh(const std::string& path, const std::string& mesh_path);

/// Adds a camera and lights to a scene without, and an exposure for its lights.
void add_defaults(AssetScene& scene);

/// Text of the scene file: indented, vectors on one line, unsupported statements in comments at its top.
std::string scene_text(const AssetScene& scene, const std::string& asset);

/// Sets the scene's center, radius and extent. for_each_point(visit): calls visit for each vertex; called repeatedly.
template <class ForEachPoint>
void enclose(AssetScene& scene, const ForEachPoint& for_each_point) {
  Vec3d low(1e300), high(-1e300);
  for_each_point([&](const Vec3d& p) { widen(low, high, p); });
  scene.center = low * .5 + high * .5;
  scene.extent = max_component(high - low);
  double square = 0;
  for_each_point([&](const Vec3d& p) { square = std::max(square, dot(p - scene.center, p - scene.center)); });
  scene.radius = std::max(std::sqrt(square), 1e-12);
}

/// Unique names: a second "wax" becomes "wax-2".
class UniqueNames {
 public:
  std::string take(const std::string& wanted, const std::string& otherwise);

 private:
  std::set<std::string> taken_;
  std::map<std::string, int> tried_;  ///< the last number behind a name
};

/// "[0.8, 0.5, 0.2]", or one number for three equal ones.
std::string short_triple(const Vec3d& value);

Json triple_json(const Vec3d& value);

}  // namespace opaline
