// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "assets/gltf_model.h"
#include "assets/gltf_texture.h"

namespace opaline {

/// The values of one extension of a material; those that are not there have defaults.
class ExtensionValues {
 public:
  ExtensionValues(const GltfModel& gltf, std::string place, const tinygltf::Value& values)
      : gltf_(gltf), place_(std::move(place)), values_(values) {}

  double number(const char* key, double otherwise) const {
    if (!values_.Has(key)) return otherwise;
    const tinygltf::Value& value = values_.Get(key);
    if (!value.IsNumber()) fail_at(gltf_.path, place_ + '.' + key, "is of the wrong type", "a number");
    return value.GetNumberAsDouble();
  }

  Vec3d color(const char* key, const Vec3d& otherwise) const {
    if (!values_.Has(key)) return otherwise;
    const tinygltf::Value& value = values_.Get(key);
    Vec3d color;
    for (std::size_t i = 0; i < 3; ++i) {
      if (value.ArrayLen() != 3 || !value.Get(int(i)).IsNumber())
        fail_at(gltf_.path, place_ + '.' + key, "is of the wrong type", "three numbers");
      color[i] = std::clamp(value.Get(int(i)).GetNumberAsDouble(), 0., 1.);
    }
    return color;
  }

  bool has(const char* key) const { return values_.Has(key); }
  /// One of its textures.
  /// in    extensions: set to those of the texture, which the result points at
  GltfTexture texture(const char* key, tinygltf::ExtensionMap& extensions) const {
    const tinygltf::Value& info = values_.Get(key);
    const auto whole = [&](const char* name, int otherwise) {
      return info.Has(name) && info.Get(name).IsInt() ? info.Get(name).GetNumberAsInt() : otherwise;
    };
    if (info.Has("extensions"))
      for (const std::string& name : info.Get("extensions").Keys())
        extensions[name] = info.Get("extensions").Get(name);
    return {whole("index", -1), whole("texCoord", 0), &extensions};
  }

  /// The names of its textures.
  std::vector<std::string> textures() const {
    std::vector<std::string> names;
    for (const std::string& key : values_.Keys())
      if (key.ends_with("Texture")) names.push_back(key);
    return names;
  }

 private:
  const GltfModel& gltf_;
  std::string place_;
  const tinygltf::Value& values_;
};

}  // namespace opaline
