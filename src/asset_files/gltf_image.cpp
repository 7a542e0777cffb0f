// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/gltf_image.h"

#include <charconv>
#include <filesystem>

#include "asset_files/asset_file.h"
#include "asset_files/gltf_file.h"
#include "asset_files/gltf_model.h"

namespace opaline {
namespace {

std::string view_bytes(const GltfModel& gltf, const GltfRecord& image) {
  if (!image.has("bufferView")) fail_at(gltf.path, image.place(), "has no data", "a uri or a bufferView");
  const std::uint32_t view = image.index("bufferView");
  if (view >= gltf.views.size())
    image.fail("bufferView", "refers to nothing", "below " + std::to_string(gltf.views.size()),
               std::to_string(view));
  return std::string(bytes_of(gltf, gltf.views[view]));
}

}  // namespace

NamedFile gltf_image_file(const GltfModel& gltf, const GltfRecord& image) {
  const std::string uri = image.text("uri");
  if (uri.empty() || is_data_uri(uri)) return {};
  const std::string name = decoded_uri(uri);
  NamedFile file = find_named_file(name, gltf.path, std::filesystem::path(gltf.path).parent_path());
  if (file.path.empty()) image.fail("uri", "refers to a missing file", "a file in the asset's folder", name);
  return file;
}

GltfImage gltf_image(const GltfModel& gltf, std::size_t index) {
  const GltfRecord image = gltf.record("images", index);
  if (const NamedFile file = gltf_image_file(gltf, image); !file.path.empty())
    return {file.path.string(), {}};
  const std::string uri = image.text("uri");
  if (uri.empty()) return {{}, view_bytes(gltf, image)};
  std::optional<std::string> data = data_of_uri(uri);
  if (!data) image.fail("uri", "cannot be read", "a file, or an image in base64");
  return {{}, *std::move(data)};
}

bool is_gltf_image(const std::string& name) {
  return name.find(kGltfImageWord) != name.npos;
}

std::string gltf_image_asset(const std::string& name) {
  return name.substr(0, name.rfind(kGltfImageWord));
}

GltfImage read_gltf_image(const std::string& name) {
  const std::string asset = gltf_image_asset(name),
                    digits = name.substr(asset.size() + kGltfImageWord.size());
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc() || end != digits.data() + digits.size())
    throw bad_file(asset, "has no such image", "#image/ and its index", '"' + digits + '"');
  return gltf_image(*load_gltf(asset), index);
}

}  // namespace opaline
