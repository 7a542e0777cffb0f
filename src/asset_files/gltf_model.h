// SPDX-License-Identifier: GPL-3.0-or-later
// A glTF file as data, with checked references.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "asset_files/asset_bytes.h"
#include "asset_files/gltf_json.h"
#include "opaline/scene.h"

namespace opaline {

struct GltfBufferView {
  std::uint32_t buffer;
  std::size_t offset, length, stride;  ///< stride 0: packed
};

/// EXT_meshopt_compression of a buffer view.
struct GltfCompressedView {
  std::uint32_t buffer;
  std::size_t offset, length, stride, count;
  std::string mode, filter;
};

enum GltfComponent : std::size_t {
  kGltfByte = 5120,
  kGltfUnsignedByte,
  kGltfShort,
  kGltfUnsignedShort,
  kGltfUnsignedInt = 5125,
  kGltfFloat
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
  std::uint32_t draco_view = kNoRecord;  ///< KHR_draco_mesh_compression
  GltfAttributes draco_ids{};            ///< attributes in Draco's data, by name
};

inline constexpr std::size_t kGltfTriangles = 4, kGltfTriangleStrip = 5, kGltfTriangleFan = 6;

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  std::vector<double> weights;  ///< weights of morph targets
};

/// Translation, rotation and scale of a node in its parent.
struct GltfPlacement {
  Vec3d translation{};
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< quaternion x, y, z, w
  Vec3d scale{1};

  Transform to_parent() const;
};

struct GltfNode {
  std::string name{};
  std::uint32_t mesh = kNoRecord, camera = kNoRecord, skin = kNoRecord, light = kNoRecord;
  std::uint32_t parent = kNoRecord;
  std::vector<std::uint32_t> children{};
  std::unique_ptr<const std::variant<GltfPlacement, Transform>> placed{};  ///< in its parent; null: identity

  Transform to_parent() const;
};

struct GltfModel {
  std::string path;
  std::string contents;               ///< hash of the file and of the buffers beside it
  std::vector<std::string> warnings;  ///< deviations of the file from the glTF specification
  std::string file;                   ///< bytes referenced by buffers
  std::deque<std::string> own_bytes;  ///< the same of other files and URIs
  std::vector<std::string_view> buffers;
  std::vector<GltfBufferView> views;
  std::map<std::size_t, GltfCompressedView> compressed_views;  ///< by buffer view
  std::vector<GltfAccessor> accessors;
  std::vector<GltfMesh> meshes;
  std::deque<GltfNode> nodes;
  std::map<std::size_t, std::vector<double>> node_weights;  ///< replace the mesh's, by node
  std::map<std::size_t, GltfAttributes> instances;          ///< EXT_mesh_gpu_instancing, by node
  std::vector<std::vector<std::uint32_t>> scenes;           ///< their roots
  std::uint32_t scene = kNoRecord;                          ///< to be shown
  std::vector<std::string> extensions_used, extensions_required;
  std::size_t record_bytes = 0;  ///< memory of the text and its nodes
  /// Lists of records read on use: an error in an unused one is not reported.
  std::map<std::string, std::vector<Json>, std::less<>> lists;

  /// A record of `lists`.
  /// error Error{bad_input}: missing
  GltfRecord record(const char* list, std::size_t index) const;
  std::size_t count(const char* list) const;
};

/// Reads a GLB or glTF file with its buffers, but not its images. Caches the last one, as an asset is loaded
/// once for its nodes and once for each of its parts.
/// out   every index between its records is in range, every buffer view within its buffer, no node has two
///       parents
/// error Error{bad_input} naming the file and the record: no such file, not glTF 2.0, a missing or short
///       buffer, a dangling reference, a value of a wrong type, mesh data in an unsupported compression
std::shared_ptr<const GltfModel> load_gltf(const std::string& path);

/// Bytes of a buffer view.
inline std::string_view bytes_of(const GltfModel& gltf, const GltfBufferView& view) {
  return gltf.buffers[view.buffer].substr(view.offset, view.length);
}

struct GltfState;

/// Transform of a node to its scene.
/// in    state: of an animation; null: at rest
/// error Error{bad_input}: it is its own parent
Transform node_to_world(const GltfModel& gltf, std::size_t node, const GltfState* state = nullptr);

/// Rotation by a quaternion x, y, z, w of any nonzero length.
Transform rotation(const std::array<double, 4>& quaternion);

}  // namespace opaline
