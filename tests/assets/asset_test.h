// SPDX-License-Identifier: GPL-3.0-or-later
// Small glTF assets, made in the tests: a document, the bytes of its buffer, and files of both.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../core/scratch_folder.h"
#include "assets/import_asset.h"
#include "geometry/make_mesh.h"
#include "input/load_scene.h"
#include "opaline/error.h"

namespace opaline::asset_test {

using Json = nlohmann::json;

enum ComponentType { kByte = 5120, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt = 5125, kFloat };

inline std::string base64(const std::string& bytes) {
  static const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? letters[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A glTF file in the making.
struct Asset {
  Json json{{"asset", {{"version", "2.0"}}}};
  std::string buffer;
  std::size_t fallback_bytes = 0;  ///< of a second buffer without data, for compressed buffer views

  /// Appends an accessor over the numbers, and its view; returns its index.
  template <class T>
  int accessor(const char* type, ComponentType component, const std::vector<T>& numbers,
               bool normalized = false) {
    const std::string name = type;
    const std::size_t per_element = name == "SCALAR" ? 1 : name == "MAT4" ? 16 : std::size_t(name[3] - '0');
    buffer.resize((buffer.size() + 3) / 4 * 4);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", numbers.size() * sizeof(T)}});
    buffer.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", int(component)},
                                 {"count", numbers.size() / per_element},
                                 {"type", type},
                                 {"normalized", normalized}});
    return int(json["accessors"].size()) - 1;
  }

  /// A mesh of one primitive; returns its index.
  int mesh(Json primitive) {
    json["meshes"].push_back({{"primitives", {std::move(primitive)}}});
    return int(json["meshes"].size()) - 1;
  }

  int node(Json node) {
    json["nodes"].push_back(std::move(node));
    return int(json["nodes"].size()) - 1;
  }

  int material(Json material) {
    json["materials"].push_back(std::move(material));
    return int(json["materials"].size()) - 1;
  }

  void root(int node) {
    if (!json.contains("scenes")) json["scenes"] = Json::array({{{"nodes", Json::array()}}});
    json["scenes"][0]["nodes"].push_back(node);
  }

  std::string gltf(const std::string& uri) const {
    Json whole = with_buffers();
    whole["buffers"][0]["uri"] = uri;
    return whole.dump();
  }
  std::string gltf() const { return gltf("data:application/octet-stream;base64," + base64(buffer)); }

  std::string glb() const {
    std::string text = with_buffers().dump(), bytes = buffer;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    bytes.resize((bytes.size() + 3) / 4 * 4);
    std::string file = "glTF";
    const auto number = [&](std::size_t value) {
      for (int i = 0; i < 4; ++i) file += char(value >> (8 * i) & 255);
    };
    number(2);
    number(12 + 8 + text.size() + 8 + bytes.size());
    number(text.size());
    file += "JSON" + text;
    number(bytes.size());
    file += std::string("BIN\0", 4) + bytes;
    return file;
  }

 private:
  Json with_buffers() const {
    Json whole = json;
    whole["buffers"] = Json::array({{{"byteLength", buffer.size()}}});
    if (fallback_bytes > 0)
      whole["buffers"].push_back({{"byteLength", fallback_bytes},
                                  {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    return whole;
  }
};

/// A cube from -1 to 1 whose 24 vertices are split at its edges, each with its face's normal.
struct Cube {
  std::vector<float> positions, normals;
  std::vector<std::uint16_t> indices;

  Cube() {
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {-1.f, 1.f}) face(axis, side);
  }

 private:
  void face(int axis, float side) {
    const auto first = std::uint16_t(positions.size() / 3);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const auto& [a, b] : {std::pair{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}}) {
      float p[3], n[3] = {0, 0, 0};
      p[axis] = n[axis] = side;
      p[u] = a, p[v] = b;
      positions.insert(positions.end(), p, p + 3);
      normals.insert(normals.end(), n, n + 3);
    }
    for (const int k : {0, 1, 2, 0, 2, 3}) indices.push_back(std::uint16_t(first + k));
    if (side < 0)
      for (std::size_t i = indices.size() - 6; i < indices.size(); i += 3)
        std::swap(indices[i + 1], indices[i + 2]);
  }
};

/// The cube as mesh 0; accessors 0, 1, 2 are its positions, normals and indices.
inline Asset cube_mesh() {
  Asset asset;
  const Cube cube;
  const int positions = asset.accessor("VEC3", kFloat, cube.positions);
  const int normals = asset.accessor("VEC3", kFloat, cube.normals);
  const int indices = asset.accessor("SCALAR", kUnsignedShort, cube.indices);
  asset.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"indices", indices}});
  return asset;
}

/// The same at a node of its own, the scene's only one.
inline Asset cube_asset() {
  Asset asset = cube_mesh();
  asset.root(asset.node({{"name", "cube"}, {"mesh", 0}}));
  return asset;
}

/// The scene that an asset's bytes become.
inline Scene scene_of(const std::string& bytes, const std::string& name = "test.gltf") {
  const ScratchFolder folder;
  put_bytes(folder.file(name), bytes);
  return load_scene(folder.file(name));
}

inline ImportedAsset imported(const Asset& asset) {
  const ScratchFolder folder;
  put_bytes(folder.file("test.glb"), asset.glb());
  return import_asset(folder.file("test.glb"), "test.glb");
}

/// what() of the Error{bad_input} that loading the bytes throws, without the folder; "" if it throws none.
inline std::string error_of(const std::string& bytes, const std::string& name = "test.gltf") {
  const ScratchFolder folder;
  put_bytes(folder.file(name), bytes);
  try {
    load_scene(folder.file(name));
  } catch (const Error& failure) {
    EXPECT_EQ(failure.kind, ErrorKind::bad_input) << failure.what();
    std::string text = failure.what();
    const std::string path = folder.path.string() + '/';
    for (std::size_t at = text.find(path); at != text.npos; at = text.find(path)) text.erase(at, path.size());
    return text;
  }
  return {};
}

inline bool has(const std::vector<std::string>& lines, const std::string& part) {
  for (const std::string& line : lines)
    if (line.find(part) != line.npos) return true;
  return false;
}

/// A part of an asset as a checked mesh.
inline CheckedMesh mesh_of(const std::string& path, const std::string& part) {
  Shape shape;
  MeshFile file;
  file.path = path;
  file.part = part;
  shape.source = file;
  return make_mesh(shape);
}

}  // namespace opaline::asset_test
