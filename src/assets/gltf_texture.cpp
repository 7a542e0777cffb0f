// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/gltf_texture.h"

#include <charconv>
#include <filesystem>
#include <numbers>
#include <string_view>

#include "assets/asset_file.h"
#include "assets/gltf_file.h"
#include "opaline/assets/gltf_image.h"
#include "opaline/core/input_file.h"

namespace opaline {
namespace {

constexpr std::string_view kImageWord = "#image/";

/// The image of a texture.
std::size_t image_of(const GltfModel& gltf, std::size_t texture) {
  const GltfRecord record = gltf.record("textures", texture);
  const std::uint32_t image = record.index("source");
  if (image == kNoRecord)
    fail_at(gltf.path, record.place(), "has no supported image", "a source, PNG or JPEG");
  return image;
}

/// File of an image outside the asset.
NamedFile file_of(const GltfModel& gltf, const GltfRecord& image) {
  const std::string uri = image.text("uri");
  if (uri.empty() || is_data_uri(uri)) return {};
  const std::string name = decoded_uri(uri);
  NamedFile file = find_named_file(name, gltf.path, std::filesystem::path(gltf.path).parent_path());
  if (file.path.empty()) image.fail("uri", "refers to a missing file", "a file in the asset's folder", name);
  return file;
}

std::string view_bytes(const GltfModel& gltf, const GltfRecord& image) {
  if (!image.has("bufferView")) fail_at(gltf.path, image.place(), "has no data", "a uri or a bufferView");
  const std::uint32_t view = image.index("bufferView");
  if (view >= gltf.views.size())
    image.fail("bufferView", "refers to nothing", "below " + std::to_string(gltf.views.size()),
               std::to_string(view));
  return std::string(bytes_of(gltf, gltf.views[view]));
}

GltfImage image_at(const GltfModel& gltf, std::size_t index) {
  const GltfRecord image = gltf.record("images", index);
  if (const NamedFile file = file_of(gltf, image); !file.path.empty()) return {file.path.string(), {}};
  const std::string uri = image.text("uri");
  if (uri.empty()) return {{}, view_bytes(gltf, image)};
  std::optional<std::string> data = data_of_uri(uri);
  if (!data) image.fail("uri", "cannot be read", "a file, or a PNG or JPEG in base64");
  return {{}, *std::move(data)};
}

/// error unless present and in one of glTF's own formats
void check_image(const GltfModel& gltf, std::size_t index) {
  const GltfImage image = image_at(gltf, index);
  std::string start = image.bytes.substr(0, 8);
  if (!image.path.empty()) start = InputFile(image.path).read(0, 8);
  if (!start.starts_with("\x89PNG") && !start.starts_with("\xff\xd8\xff"))
    fail_at(gltf.path, record_name("images", index), "is not a supported image", "PNG or JPEG");
}

Json pair_json(const GltfRecord& transform, const char* key, double otherwise) {
  const std::vector<double> pair = transform.numbers(key, 2);
  return pair.empty() ? Json::array({otherwise, otherwise}) : Json(pair);
}

void add_transform(const GltfRecord& transform, Json& json) {
  if (transform.has("scale")) json["uv_scale"] = pair_json(transform, "scale", 1);
  if (transform.has("rotation"))
    json["uv_rotation"] = transform.number("rotation", 0) * 180 / std::numbers::pi;
  if (transform.has("offset")) json["uv_offset"] = pair_json(transform, "offset", 0);
}

}  // namespace

Json texture_json(const GltfModel& gltf, const GltfRecord& info, const std::string& mesh_path,
                  std::string& warning) {
  const GltfRecord transform = info.record("extensions").record("KHR_texture_transform");
  const std::size_t uv_set = transform.size("texCoord", info.size("texCoord", 0)),
                    texture = info.index("index");
  if (uv_set != 0)
    fail_at(gltf.path, record_name("textures", texture), "uses another set of UVs", "TEXCOORD_0",
            "TEXCOORD_" + std::to_string(uv_set));
  const std::size_t image = image_of(gltf, texture);
  check_image(gltf, image);
  const NamedFile file = file_of(gltf, gltf.record("images", image));
  warning = file.warning;
  Json json{{"texture", file.path.empty() ? mesh_path + std::string(kImageWord) + std::to_string(image)
                                          : scene_name_of(file.path, gltf.path, mesh_path)}};
  add_transform(transform, json);
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
