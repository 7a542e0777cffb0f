// SPDX-License-Identifier: GPL-3.0-or-later
// PLY, STL and OFF: one opaque shape with the file's vertex colours, or grey.
#include <cctype>
#include <filesystem>

#include "assets/asset_scene.h"
#include "geometry/read_mesh.h"
#include "opaline/error.h"

namespace opaline {

AssetScene import_mesh(const std::string& path, const std::string& mesh_path) {
  const SourceMesh mesh = read_mesh(path);
  if (mesh.triangles.empty()) throw bad_file(path, "contains no visible mesh", "a mesh with faces");
  AssetScene scene;
  enclose(scene, [&](const auto& visit) {
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t v : triangle) visit(mesh.positions[v]);
  });
  const std::filesystem::path file(path);
  std::string format = file.extension().string().substr(1);
  for (char& c : format) c = char(std::toupper(static_cast<unsigned char>(c)));
  scene.translated.push_back(format + " has no unit: lengths are read as millimetres");
  scene.has_vertex_colors = !mesh.colors.empty();
  Json shape{{"name", file.stem().string()}, {"file", mesh_path}};
  if (scene.has_vertex_colors) {
    scene.translated.push_back("vertex colours -> reflectance");
  } else {
    constexpr double kGrey = .5;
    shape["reflectance"] = kGrey;
    scene.translated.push_back(format + " has no material: reflectance 0.5 (opaque)");
  }
  scene.is_one_mesh = true;
  scene.shapes.push_back(std::move(shape));
  return scene;
}

}  // namespace opaline
