// SPDX-License-Identifier: GPL-3.0-or-later
// A glTF file as data, its references checked.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "asset_files/asset_bytes.h"
#include "asset_files/gltf_json.h"
#include "opaline/scene.h"

namespace opaline {

struct GltfBufferView {
  std::uint32_t buffer;
  std::size_t offset, length, stride;  ///< stride 0: packed
};

struct GltfSparse {
  std::size_t count = 0, index_offset = 0, value_offset = 0;
  std::uint32_t index_view = 0, value_view = 0;
  std::size_t index_component = 0;
};

struct GltfAccessor {
  std::uint32_t view = kNoRecord;  ///< none: all zero
  std::size_t offset = 0, count = 0, component = 0;
  std::string type{};  ///< "VEC3"
  bool is_normalized = false;
  std::optional<GltfSparse> sparse{};
};

using GltfAttributes = std::map<std::string, std::uint32_t, std::less<>>;

struct GltfPrimitive {
  GltfAttributes attributes{};
  std::uint32_t indices = kNoRecord, material = kNoRecord;
  std::size_t mode = 0;
  std::vector<GltfAttributes> targets{};
};

inline constexpr std::size_t kGltfTriangles = 4, kGltfTriangleStrip = 5, kGltfTriangleFan = 6;

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  std::vector<double> weights;  ///< weights of morph targets
};

struct GltfNode {
  std::string name{};
  std::uint32_t mesh = kNoRecord, camera = kNoRecord, skin = kNoRecord, light = kNoRecord;
  std::uint32_t parent = kNoRecord;
  std::vector<std::uint32_t> children{};
  std::unique_ptr<const Transform> placed{};  ///< in its parent; null: as that

  Transform to_parent() const { return placed ? *placed : Transform{}; }
};

struct GltfModel {
  std::string path;
  std::string contents;               ///< hash of the file and of the buffers beside it
  std::vector<std::string> warnings;  ///< warnings of a file that is not as glTF wants it
  std::string file;                   ///< bytes that buffers point into
  std::deque<std::string> own_bytes;  ///< the same of other files and URIs
  std::vector<std::string_view> buffers;
  std::vector<GltfBufferView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfMesh> meshes;
  std::deque<GltfNode> nodes;
  std::map<std::size_t, std::vector<double>> node_weights;  ///< in place of the mesh's, by node
  std::map<std::size_t, GltfAttributes> instances;          ///< EXT_mesh_gpu_instancing, by node
  std::vector<std::vector<std::uint32_t>> scenes;           ///< their roots
  std::uint32_t scene = kNoRecord;                          ///< to be shown
  std::vector<std::string> extensions_used, extensions_required;
  std::size_t animations = 0;
  std::size_t record_bytes = 0;  ///< memory that the text and its nodes take, which may be a million
  /// Lists whose records are read where they are used: a mistake in another one costs nothing.
  std::map<std::string, std::vector<Json>, std::less<>> lists;

  /// A record of `lists`.
  /// error Error{bad_input}: it is not there
  GltfRecord record(const char* list, std::size_t index) const;
  std::size_t count(const char* list) const;
};

/// Reads a GLB or glTF file with its buffers, but not its images. The last one read is kept: an asset is asked for
/// once for its nodes and once for each of its parts.
/// out   every index between its records is in range, every buffer view within its buffer, no node has two parents
/// error Error{bad_input} naming the file and the record: no such file, not glTF 2.0, a buffer that is missing or
///       short, a reference to nothing, a value of a wrong type, mesh data in a compression that is not read
std::shared_ptr<const GltfModel> load_gltf(const std::string& path);

/// Bytes of a buffer view.
inline std::string_view bytes_of(const GltfModel& gltf, const GltfBufferView& view) {
  return gltf.buffers[view.buffer].substr(view.offset, view.length);
}

/// Where a node is in its scene.
/// error Error{bad_input}: it is its own parent
Transform node_to_world(const GltfModel& gltf, std::size_t node);

/// Turns as a quaternion x, y, z, w says, of any length but 0.
Transform rotation(const std::array<double, 4>& quaternion);

/// First `first`, then `second`.
Transform compose(const Transform& second, const Transform& first);

}  // namespace opaline
