// SPDX-License-Identifier: GPL-3.0-or-later
// The cube of asset_test.h, compressed by the libraries' own encoders.
#pragma once

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include "asset_test.h"

namespace opaline::asset_test {

/// Replaces a buffer view by compressed bytes, as EXT_meshopt_compression has it.
inline void set_compressed(Asset& asset, std::size_t view, const std::vector<unsigned char>& bytes,
                           Json extension) {
  asset.buffer.resize((asset.buffer.size() + 3) / 4 * 4);
  extension["buffer"] = 0;
  extension["byteOffset"] = asset.buffer.size();
  extension["byteLength"] = bytes.size();
  asset.buffer.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t size = extension["count"].get<std::size_t>() * extension["byteStride"].get<std::size_t>();
  Json& json = asset.json["bufferViews"][view];
  json = {{"buffer", 1},
          {"byteOffset", asset.fallback_bytes},
          {"byteLength", size},
          {"extensions", {{"EXT_meshopt_compression", extension}}}};
  if (extension["mode"] == "ATTRIBUTES") json["byteStride"] = extension["byteStride"];
  asset.fallback_bytes += size;
}

inline std::vector<unsigned char> encoded_vertices(const void* vertices, std::size_t count,
                                                   std::size_t stride) {
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(count, stride));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), vertices, count, stride));
  return bytes;
}

/// Positions by the exponential filter, normals by the octahedral one in bytes, triangles.
inline Asset meshopt_cube() {
  const Cube cube;
  const std::size_t count = cube.positions.size() / 3;
  Asset asset = cube_asset();
  asset.buffer.clear();
  meshopt_encodeVertexVersion(0);
  meshopt_encodeIndexVersion(1);
  std::vector<std::uint32_t> exponents(cube.positions.size());
  for (std::size_t i = 0; i < exponents.size(); ++i)  // mantissa * 2^exponent, each number by itself
    exponents[i] =
        std::uint32_t(std::int32_t(cube.positions[i] * 1024) & 0xffffff) | (std::uint32_t(-10) << 24);
  set_compressed(asset, 0, encoded_vertices(exponents.data(), count, 12),
                 {{"byteStride", 12}, {"count", count}, {"mode", "ATTRIBUTES"}, {"filter", "EXPONENTIAL"}});
  std::vector<std::int8_t> normals(count * 4);
  std::vector<float> four(count * 4);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k) four[i * 4 + k] = cube.normals[i * 3 + k];
  meshopt_encodeFilterOct(normals.data(), count, 4, 8, four.data());
  set_compressed(asset, 1, encoded_vertices(normals.data(), count, 4),
                 {{"byteStride", 4}, {"count", count}, {"mode", "ATTRIBUTES"}, {"filter", "OCTAHEDRAL"}});
  asset.json["accessors"][1]["componentType"] = int(kByte);
  asset.json["accessors"][1]["normalized"] = true;
  std::vector<unsigned char> triangles(meshopt_encodeIndexBufferBound(cube.indices.size(), count));
  const std::vector<std::uint32_t> indices(cube.indices.begin(), cube.indices.end());
  triangles.resize(
      meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), indices.size()));
  set_compressed(asset, 2, triangles, {{"byteStride", 2}, {"count", indices.size()}, {"mode", "TRIANGLES"}});
  asset.json["extensionsRequired"] =
      asset.json["extensionsUsed"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  return asset;
}

/// in    speed: 0 to 10, slowest and smallest first; 10 keeps the order of vertices
inline Asset draco_cube(int speed) {
  const Cube cube;
  const std::uint32_t count = std::uint32_t(cube.positions.size() / 3);
  draco::Mesh mesh;
  mesh.set_num_points(count);
  const auto add = [&](draco::GeometryAttribute::Type type, const std::vector<float>& numbers) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, 3, draco::DT_FLOAT32, false, 3 * sizeof(float), 0);
    const int id = mesh.AddAttribute(attribute, true, count);
    for (std::uint32_t i = 0; i < count; ++i)
      mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), numbers.data() + i * 3);
    return mesh.attribute(id)->unique_id();
  };
  const std::uint32_t positions = add(draco::GeometryAttribute::POSITION, cube.positions),
                      normals = add(draco::GeometryAttribute::NORMAL, cube.normals);
  for (std::size_t i = 0; i < cube.indices.size(); i += 3)
    mesh.AddFace({draco::PointIndex(cube.indices[i]), draco::PointIndex(cube.indices[i + 1]),
                  draco::PointIndex(cube.indices[i + 2])});
  draco::Encoder encoder;
  encoder.SetSpeedOptions(speed, speed);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
  draco::EncoderBuffer bytes;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &bytes).ok());
  Asset asset = cube_asset();
  asset.buffer.assign(bytes.data(), bytes.size());
  asset.json["bufferViews"] = {{{"buffer", 0}, {"byteLength", bytes.size()}}};
  for (Json& accessor : asset.json["accessors"]) accessor.erase("bufferView");
  asset.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 0}, {"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}};
  asset.json["extensionsRequired"] = asset.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  return asset;
}

}  // namespace opaline::asset_test
