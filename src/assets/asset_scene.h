// SPDX-License-Identifier: GPL-3.0-or-later
// A scene on its way from an asset to the text of a scene file.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
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

/// Lengths in the asset's unit. Each Json as the scene file has it; null or empty: the asset has none.
struct AssetScene {
  double mm_per_unit = 1;
  Json media = Json::object(), shapes = Json::array(), lights = Json::array(), camera, film = Json::object();
  Vec3d center;                  ///< center of the box around the shapes
  double radius = 1;             ///< from there to the outermost vertex
  double center_irradiance = 0;  ///< that its lights bring to a surface there facing them
  bool is_one_mesh = false;      ///< its shapes are parts of one body
  bool has_vertex_colors = false;
  std::vector<std::string> translated, not_carried;
  std::vector<std::string> warnings;  ///< warnings of what changes the image
  std::size_t bytes = 0;              ///< as ImportedAsset's

  /// Something of a file or a record in it that is lost and changes the image.
  void warn(const std::string& place, const std::string& what) {
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

/// Where an asset is, and how the scene file calls it.
struct AssetPlace {
  std::string path, mesh_path;
};

/// A surface of a MaterialX file.
/// in    file_and_name: "skin.mtlx", or "skin.mtlx#name" of a surface or material in it; scene: whose unit its lengths
///       are in, and which is told what became of the values
/// error Error{bad_input} naming the file: no XML, no such surface, a value that is not of its type
SurfaceTranslation translate_materialx(const std::string& file_and_name, const AssetPlace& asset,
                                       AssetScene& scene);

AssetScene import_gltf(const std::string& path, const std::string& mesh_path);
AssetScene import_obj(const std::string& path, const std::string& mesh_path);
/// PLY, STL and OFF.
AssetScene import_mesh(const std::string& path, const std::string& mesh_path);

/// Gives a camera and lights to a scene without, and an exposure that suits its lights.
void add_defaults(AssetScene& scene);

/// The scene file's text: indented, numbers belonging together on one line, what was not carried over in
/// comments at its top.
std::string scene_text(const AssetScene& scene, const std::string& asset);

/// Sets the scene's center and radius. for_each_point(visit): calls visit of each vertex, each time it is called.
template <class ForEachPoint>
void enclose(AssetScene& scene, const ForEachPoint& for_each_point) {
  Vec3d low(1e300), high(-1e300);
  for_each_point([&](const Vec3d& p) {
    low = component_min(low, p);
    high = component_max(high, p);
  });
  scene.center = low * .5 + high * .5;
  double square = 0;
  for_each_point([&](const Vec3d& p) { square = std::max(square, dot(p - scene.center, p - scene.center)); });
  scene.radius = std::max(std::sqrt(square), 1e-12);
}

/// Names, each used once: a second "wax" becomes "wax-2".
class UniqueNames {
 public:
  std::string take(const std::string& wanted, const std::string& otherwise);

 private:
  std::set<std::string> taken_;
  std::map<std::string, int> tried_;  ///< the last number behind a name
};

/// "[0.8, 0.5, 0.2]", or one number where the three are the same.
std::string short_triple(const Vec3d& value);

Json triple_json(const Vec3d& value);

}  // namespace opaline
