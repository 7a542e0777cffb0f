// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of an asset of another program (GLB, glTF 2.0, OBJ with MTL, PLY, STL, OFF) to the text of a
// scene file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "opaline/vec3.h"

namespace opaline {

class TextureFile;

/// settings.max_samples of an opaque asset, made translucent without a size: its unit is a guess.
inline constexpr int kMostUnsizedSamples = 200000;

/// Default camera and lights around an asset, in its unit.
struct AssetDefaults {
  bool camera = false, lights = false;  ///< false: the asset has its own
  Vec3d center{};                       ///< centre of the sphere around the asset
  double radius = 1;
  double extent = 0;    ///< largest side of the box around it
  bool opaque = false;  ///< true without media of its own, in its unit
};

struct ImportedAsset {
  std::string text;                      ///< a scene file, see scenes/README.md
  std::vector<std::string> translated;   ///< conversions of values, a line each
  std::vector<std::string> not_carried;  ///< parts without import, and warnings, a line each
  std::vector<std::string> warnings;     ///< missing files and other changes of the image, a line each
  std::string summary;                   ///< one line, without the warnings
  std::size_t bytes = 0;                 ///< memory of its records during reading
  std::vector<std::shared_ptr<const TextureFile>> textures = {};  ///< opened already: the scene reuses them
  AssetDefaults defaults{};
};

/// True for a file name with an asset's extension, in upper or lower case.
bool is_asset_name(const std::string& path);

/// in    path: an asset; mesh_path: its name in the scene file, relative to that file's folder; material: a
///       MaterialX file replacing the asset's materials, "skin.mtlx" or "skin.mtlx#name" of a surface or
///       material in it; animation: name or index of a glTF animation; empty: the first readable one
/// out   a valid scene with a visible shape: with a camera and lights, the asset's or default ones
/// error Error{bad_input} naming the file and the record: missing, broken, or without a triangle
ImportedAsset import_asset(const std::string& path, const std::string& mesh_path,
                           const std::string& material = {}, const std::string& animation = {});

/// Overrides placing the default camera and lights of the asset's scene.
/// in    camera: position of the camera in use, for the lights; none: the default one
std::vector<std::string> placement(const AssetDefaults& defaults, const std::optional<Vec3d>& camera);

}  // namespace opaline
