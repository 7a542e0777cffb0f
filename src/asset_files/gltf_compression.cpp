// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/gltf_compression.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>

#include "asset_files/asset_file.h"
#include "asset_files/gltf_accessor.h"

namespace opaline {
namespace {

/// Decoded bytes of a compressed one are at most so many: 64 by the vertex codec, whose all-zero groups of 16 values take
/// two bits, and a few whole blocks.
constexpr std::size_t kMostExpansion = 64, kSpareBytes = 1 << 16;

/// Returns a view of all of a new buffer.
GltfBufferView add_buffer(GltfModel& gltf, std::string bytes, std::size_t stride = 0) {
  gltf.own_bytes.push_back(std::move(bytes));
  gltf.buffers.push_back(gltf.own_bytes.back());
  return {std::uint32_t(gltf.buffers.size() - 1), 0, gltf.buffers.back().size(), stride};
}

std::uint32_t add_view(GltfModel& gltf, std::string bytes) {
  gltf.views.push_back(add_buffer(gltf, std::move(bytes)));
  return std::uint32_t(gltf.views.size() - 1);
}

/// Numbers in an element of an accessor; 0: unknown.
std::size_t components_of(std::string_view type) {
  constexpr std::string_view kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  const auto* const found = std::ranges::find(kTypes, type);
  return found == std::end(kTypes) ? 0 : std::size_t(found - kTypes) + 1;
}

class ViewDecoder {
 public:
  ViewDecoder(const GltfModel& gltf, std::size_t index, const GltfCompressedView& view)
      : gltf_(gltf), view_(view), place_(record_name("bufferViews", index)) {}

  std::string run() const {
    if (view_.buffer >= gltf_.buffers.size())
      fail("refers to nothing", fmt::format("a buffer below {}", gltf_.buffers.size()),
           std::to_string(view_.buffer));
    const std::string_view buffer = gltf_.buffers[view_.buffer];
    if (view_.offset > buffer.size() || view_.length > buffer.size() - view_.offset)
      fail("reaches beyond its buffer", fmt::format("within {} bytes", buffer.size()),
           fmt::format("{} from {}", view_.length, view_.offset));
    const std::string_view coded = buffer.substr(view_.offset, view_.length);
    check_stride();
    const std::size_t most = (coded.size() * kMostExpansion + kSpareBytes) / view_.stride;
    if (view_.count > most)
      fail("has more elements than its bytes can hold", fmt::format("at most {}", most),
           std::to_string(view_.count));
    std::string bytes(view_.count * view_.stride, '\0');
    if (!bytes.empty() && decode(coded, bytes) != 0)
      fail("cannot be decoded", "data by meshoptimizer's " + view_.mode + " codec");
    filter(bytes);
    return bytes;
  }

 private:
  [[noreturn]] void fail(const std::string& message, const std::string& expected,
                         const std::string& got = {}) const {
    fail_at(gltf_.path, place_ + ".extensions.EXT_meshopt_compression", message, expected, got);
  }

  bool is_filtered_by(std::string_view name) const { return view_.filter == name; }

  void check_stride() const {
    const std::size_t stride = view_.stride;
    const auto expect = [&](bool is_valid, const char* expected) {
      if (!is_valid) fail("has an invalid byteStride", expected, std::to_string(stride));
    };
    if (view_.mode == "ATTRIBUTES") {
      expect(stride >= 4 && stride <= 256 && stride % 4 == 0, "a multiple of 4 up to 256");
      if (is_filtered_by("OCTAHEDRAL")) expect(stride == 4 || stride == 8, "4 or 8");
      if (is_filtered_by("QUATERNION")) expect(stride == 8, "8");
      return;
    }
    if (view_.mode != "TRIANGLES" && view_.mode != "INDICES")
      fail("has an unknown mode", "ATTRIBUTES, TRIANGLES or INDICES", in_quotes(view_.mode));
    expect(stride == 2 || stride == 4, "2 or 4");
    if (view_.mode == "TRIANGLES" && view_.count % 3 != 0)
      fail("has an invalid count", "a multiple of 3", std::to_string(view_.count));
  }

  /// out   0: no error
  int decode(std::string_view coded, std::string& bytes) const {
    const auto* data = reinterpret_cast<const unsigned char*>(coded.data());
    if (view_.mode == "ATTRIBUTES")
      return meshopt_decodeVertexBuffer(bytes.data(), view_.count, view_.stride, data, coded.size());
    if (view_.mode == "TRIANGLES")
      return meshopt_decodeIndexBuffer(bytes.data(), view_.count, view_.stride, data, coded.size());
    return meshopt_decodeIndexSequence(bytes.data(), view_.count, view_.stride, data, coded.size());
  }

  void filter(std::string& bytes) const {
    if (is_filtered_by("NONE")) return;
    if (view_.mode != "ATTRIBUTES" ||
        (!is_filtered_by("OCTAHEDRAL") && !is_filtered_by("QUATERNION") && !is_filtered_by("EXPONENTIAL")))
      fail("has an unknown filter", "NONE, or OCTAHEDRAL, QUATERNION or EXPONENTIAL of attributes",
           in_quotes(view_.filter));
    if (is_filtered_by("OCTAHEDRAL")) meshopt_decodeFilterOct(bytes.data(), view_.count, view_.stride);
    if (is_filtered_by("QUATERNION")) meshopt_decodeFilterQuat(bytes.data(), view_.count, view_.stride);
    if (is_filtered_by("EXPONENTIAL")) meshopt_decodeFilterExp(bytes.data(), view_.count, view_.stride);
  }

  const GltfModel& gltf_;
  const GltfCompressedView& view_;
  std::string place_;
};

class PrimitiveDecoder {
 public:
  PrimitiveDecoder(GltfModel& gltf, GltfPrimitive& primitive, std::string place)
      : gltf_(gltf), primitive_(primitive), place_(std::move(place)) {}

  void run() {
    const std::string_view coded = bytes_of(gltf_, gltf_.views[primitive_.draco_view]);
    draco::DecoderBuffer buffer;
    buffer.Init(coded.data(), coded.size());
    const std::unique_ptr<draco::Mesh> mesh = decoded(buffer);
    for (const auto& [name, id] : primitive_.draco_ids) take_attribute(*mesh, name, id);
    take_indices(*mesh);
    primitive_.mode = kGltfTriangles;
  }

 private:
  [[noreturn]] void fail(const std::string& message, const std::string& expected,
                         const std::string& got = {}) const {
    fail_at(gltf_.path, place_ + ".extensions.KHR_draco_mesh_compression", message, expected, got);
  }

  /// Draco allocates by numbers in the data.
  std::unique_ptr<draco::Mesh> decoded(draco::DecoderBuffer& buffer) const try {
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok()) fail("cannot be decoded", "a mesh by Draco", result.status().error_msg_string());
    return std::move(result).value();
  } catch (const std::bad_alloc&) {
    fail("cannot be decoded", "a mesh that fits in memory");
  } catch (const std::length_error&) {
    fail("cannot be decoded", "a mesh that fits in memory");
  }

  void take_attribute(const draco::Mesh& mesh, const std::string& name, std::uint32_t id) {
    const auto found = primitive_.attributes.find(name);
    if (found == primitive_.attributes.end()) fail("has an attribute of no accessor", "an accessor", name);
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
    if (attribute == nullptr) fail("has no such attribute", "the id of " + name, std::to_string(id));
    GltfAccessor& accessor = gltf_.accessors[found->second];
    const std::size_t components = components_of(accessor.type);
    if (components == 0 || std::size_t(attribute->num_components()) != components)
      fail("has the wrong number of components in " + name, accessor.type,
           std::to_string(attribute->num_components()));
    with_component(accessor.component, [&](auto zero) {
      using Number = decltype(zero);
      std::string bytes(mesh.num_points() * components * sizeof(Number), '\0');
      std::vector<Number> element(components);
      for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
        const draco::AttributeValueIndex value = attribute->mapped_index(draco::PointIndex(i));
        if (!attribute->ConvertValue<Number>(value, std::int8_t(components), element.data()))
          fail("has numbers that do not fit the componentType of " + name,
               record_name("accessors", found->second), std::to_string(accessor.component));
        std::memcpy(bytes.data() + i * components * sizeof(Number), element.data(),
                    components * sizeof(Number));
      }
      accessor.view = add_view(gltf_, std::move(bytes));
    });
    accessor.offset = 0;
    accessor.count = mesh.num_points();
    accessor.sparse.reset();
  }

  void take_indices(const draco::Mesh& mesh) {
    if (primitive_.indices == kNoRecord) fail("has no indices", "an accessor for them");
    std::vector<std::uint32_t> corners;
    corners.reserve(mesh.num_faces() * std::size_t(3));
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
      for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(f)))
        corners.push_back(corner.value());
    GltfAccessor& accessor = gltf_.accessors[primitive_.indices];
    accessor = {.view = add_view(gltf_, std::string(reinterpret_cast<const char*>(corners.data()),
                                                    corners.size() * sizeof corners[0])),
                .count = corners.size(),
                .component = kGltfUnsignedInt,
                .type = "SCALAR"};
  }

  GltfModel& gltf_;
  GltfPrimitive& primitive_;
  std::string place_;
};

}  // namespace

void decode_buffer_views(GltfModel& gltf) {
  for (const auto& [index, compressed] : gltf.compressed_views)
    gltf.views[index] = add_buffer(gltf, ViewDecoder(gltf, index, compressed).run(),
                                   compressed.mode == "ATTRIBUTES" ? compressed.stride : 0);
}

void decode_primitives(GltfModel& gltf) {
  std::vector<PrimitiveDecoder> compressed;
  for (std::size_t m = 0; m < gltf.meshes.size(); ++m)
    for (std::size_t p = 0; p < gltf.meshes[m].primitives.size(); ++p) {
      GltfPrimitive& primitive = gltf.meshes[m].primitives[p];
      const auto positions = primitive.attributes.find("POSITION");
      if (primitive.draco_view != kNoRecord && positions != primitive.attributes.end() &&
          gltf.accessors[positions->second].view == kNoRecord)
        compressed.emplace_back(gltf, primitive,
                                record_name("meshes", m) + '.' + record_name("primitives", p));
    }
  for (PrimitiveDecoder& primitive : compressed) primitive.run();
}

}  // namespace opaline
