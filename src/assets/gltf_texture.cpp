// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/gltf_texture.h"

#include <charconv>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string_view>

#include "opaline/assets/gltf_image.h"
#include "opaline/core/input_file.h"

namespace opaline {
namespace {

constexpr std::string_view kImageWord = "#image/";

/// A record of a list that was kept as text.
Json record_of(const GltfModel& gltf, const std::string& list, const char* name, std::size_t index) {
  const Json records = Json::parse(list.empty() ? "[]" : list, nullptr, false);
  if (!records.is_array() || index >= records.size())
    fail_at(gltf.path, record_name(name, index), "is not there",
            records.is_array() ? "below " + std::to_string(records.size()) : "a list of records");
  if (!records[index].is_object()) fail_at(gltf.path, record_name(name, index), "is no record", "an object");
  return records[index];
}

std::optional<std::size_t> index_in(const Json& record, const char* key) {
  const auto found = record.find(key);
  if (found == record.end() || !found->is_number_unsigned()) return {};
  return found->get<std::size_t>();
}

std::string uri_of(const Json& image) {
  const auto found = image.find("uri");
  return found == image.end() || !found->is_string() ? "" : found->get<std::string>();
}

bool is_data(const std::string& uri) {
  return uri.starts_with("data:");
}

/// "%20" and the like as the bytes that they stand for.
std::string decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned byte = 0;
    const char* const digits = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      text += char(byte);
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

std::string data_of(const GltfModel& gltf, const std::string& uri, std::size_t index) {
  std::vector<unsigned char> bytes;
  std::string type;
  if (!tinygltf::DecodeDataURI(&bytes, type, uri, 0, false))
    fail_at(gltf.path, record_name("images", index) + ".uri", "cannot be read",
            "a file, or a PNG or JPEG in base64");
  return {bytes.begin(), bytes.end()};
}

std::string view_bytes(const GltfModel& gltf, std::size_t view, std::size_t image) {
  if (view >= gltf.model.bufferViews.size())
    fail_at(gltf.path, record_name("images", image) + ".bufferView", "points at nothing",
            "below " + std::to_string(gltf.model.bufferViews.size()), std::to_string(view));
  const tinygltf::BufferView& found = gltf.model.bufferViews[view];
  const std::vector<unsigned char>& data = gltf.model.buffers[std::size_t(found.buffer)].data;
  return {reinterpret_cast<const char*>(data.data()) + found.byteOffset, found.byteLength};
}

/// The image of a texture.
std::size_t image_of(const GltfModel& gltf, int texture) {
  const Json record = record_of(gltf, gltf.textures, "textures", std::size_t(texture));
  const std::optional<std::size_t> image = index_in(record, "source");
  if (!image)
    fail_at(gltf.path, record_name("textures", std::size_t(texture)), "has no image that is read",
            "a source, PNG or JPEG");
  return *image;
}

GltfImage image_at(const GltfModel& gltf, std::size_t index) {
  const Json image = record_of(gltf, gltf.images, "images", index);
  const std::string uri = uri_of(image);
  if (!uri.empty() && !is_data(uri))
    return {(std::filesystem::path(gltf.path).parent_path() / decoded(uri)).string(), {}};
  if (!uri.empty()) return {{}, data_of(gltf, uri, index)};
  const std::optional<std::size_t> view = index_in(image, "bufferView");
  if (!view) fail_at(gltf.path, record_name("images", index), "has no data", "a uri or a bufferView");
  return {{}, view_bytes(gltf, *view, index)};
}

/// error unless it is there and of a kind that glTF itself has
void check_image(const GltfModel& gltf, std::size_t index) {
  const GltfImage image = image_at(gltf, index);
  std::string start = image.bytes.substr(0, 8);
  if (!image.path.empty()) start = InputFile(image.path).read(0, 8);
  if (!start.starts_with("\x89PNG") && !start.starts_with("\xff\xd8\xff"))
    fail_at(gltf.path, record_name("images", index), "is no picture that is read", "PNG or JPEG");
}

/// How a scene file calls an image: the file beside the asset that it is, else the asset's with "#image/3".
std::string image_name(const GltfModel& gltf, std::size_t image, const std::string& mesh_path) {
  const std::string uri = uri_of(record_of(gltf, gltf.images, "images", image));
  if (uri.empty() || is_data(uri)) return mesh_path + std::string(kImageWord) + std::to_string(image);
  return (std::filesystem::path(mesh_path).parent_path() / decoded(uri)).string();
}

Json pair_json(const tinygltf::Value& transform, const char* key, double otherwise) {
  Json pair = Json::array({otherwise, otherwise});
  if (!transform.Has(key)) return pair;
  for (std::size_t i = 0; i < 2; ++i)
    if (transform.Get(key).ArrayLen() == 2 && transform.Get(key).Get(int(i)).IsNumber())
      pair[i] = transform.Get(key).Get(int(i)).GetNumberAsDouble();
  return pair;
}

void add_transform(const tinygltf::Value& transform, Json& json) {
  if (transform.Has("scale")) json["uv_scale"] = pair_json(transform, "scale", 1);
  if (transform.Has("rotation") && transform.Get("rotation").IsNumber())
    json["uv_rotation"] = transform.Get("rotation").GetNumberAsDouble() * 180 / std::numbers::pi;
  if (transform.Has("offset")) json["uv_offset"] = pair_json(transform, "offset", 0);
}

}  // namespace

Json texture_json(const GltfModel& gltf, const GltfTexture& texture, const std::string& mesh_path) {
  int uv_set = texture.uv_set;
  const auto found = texture.extensions->find("KHR_texture_transform");
  const tinygltf::Value* const transform = found == texture.extensions->end() ? nullptr : &found->second;
  if (transform != nullptr && transform->Has("texCoord") && transform->Get("texCoord").IsInt())
    uv_set = transform->Get("texCoord").GetNumberAsInt();
  if (uv_set != 0)
    fail_at(gltf.path, record_name("textures", std::size_t(texture.index)), "is laid by another set of UVs",
            "TEXCOORD_0", "TEXCOORD_" + std::to_string(uv_set));
  const std::size_t image = image_of(gltf, texture.index);
  check_image(gltf, image);
  Json json{{"texture", image_name(gltf, image, mesh_path)}};
  if (transform != nullptr) add_transform(*transform, json);
  return json;
}

bool is_gltf_image(const std::string& name) {
  return name.find(kImageWord) != name.npos;
}

std::string gltf_image_asset(const std::string& name) {
  return name.substr(0, name.rfind(kImageWord));
}

GltfImage read_gltf_image(const std::string& name) {
  const std::string asset = gltf_image_asset(name), digits = name.substr(asset.size() + kImageWord.size());
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc() || end != digits.data() + digits.size())
    throw bad_file(asset, "has no such image", "#image/ and its index", '"' + digits + '"');
  return image_at(*load_gltf(asset), index);
}

}  // namespace opaline
