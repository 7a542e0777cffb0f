// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/gltf_texture.h"

#include <numbers>

#include "asset_files/asset_file.h"
#include "asset_files/gltf_file.h"
#include "asset_files/gltf_image.h"
#include "asset_files/gltf_uv_set.h"
#include "core/input_file.h"
#include "image/texture_file.h"

namespace opaline {
namespace {

/// The image of a texture.
std::size_t image_of(const GltfModel& gltf, std::size_t texture) {
  const GltfRecord record = gltf.record("textures", texture);
  const std::uint32_t web = record.record("extensions").record("EXT_texture_webp").index("source"),
                      image = web != kNoRecord ? web : record.index("source");
  if (image == kNoRecord)
    fail_at(gltf.path, record.place(), "has no supported image", "a source, PNG, JPEG or WebP");
  return image;
}

/// error unless present, in a format of glTF or its extensions, and undamaged
std::shared_ptr<const TextureFile> opened_image(const GltfModel& gltf, std::size_t index, bool is_color) {
  const GltfImage image = gltf_image(gltf, index);
  try {
    std::string start = image.bytes.substr(0, 8);
    if (!image.path.empty()) start = InputFile(image.path).read(0, 8);
    if (!start.starts_with("\x89PNG") && !start.starts_with("\xff\xd8\xff") && !start.starts_with("RIFF"))
      throw bad_file(gltf.path, "not a PNG, JPEG or WebP");
    return TextureFile::open_as(
        image.path.empty() ? gltf.path + std::string(kGltfImageWord) + std::to_string(index) : image.path,
        is_color);
  } catch (const Error& failure) {
    if (failure.kind != ErrorKind::bad_input) throw;
    const std::string name =
        image.path.empty() ? "" : ' ' + in_quotes(std::filesystem::path(image.path).filename().string());
    fail_at(gltf.path, record_name("images", index) + name, "cannot be used: " + failure.message);
  }
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

Json texture_json(const GltfModel& gltf, const GltfRecord& info, std::size_t uv_set,
                  const std::string& mesh_path, bool is_color,
                  std::vector<std::shared_ptr<const TextureFile>>& opened, std::string& warning) {
  const GltfRecord transform = info.record("extensions").record("KHR_texture_transform");
  const std::size_t texture = info.index("index");
  if (const std::size_t own = uv_set_of(info); own != uv_set)
    fail_at(gltf.path, record_name("textures", texture), "uses another set of UVs", uv_attribute(uv_set),
            uv_attribute(own));
  const std::size_t image = image_of(gltf, texture);
  opened.push_back(opened_image(gltf, image, is_color));
  const NamedFile file = gltf_image_file(gltf, gltf.record("images", image));
  warning = file.warning;
  Json json{{"texture", file.path.empty() ? mesh_path + std::string(kGltfImageWord) + std::to_string(image)
                                          : scene_name_of(file.path, gltf.path, mesh_path)}};
  add_transform(transform, json);
  return json;
}

}  // namespace opaline
