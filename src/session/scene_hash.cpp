// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/scene_hash.h"

#include <OpenImageIO/hash.h>
#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "assets/import_asset.h"
#include "core/input_file.h"
#include "geometry/mesh_file.h"
#include "image/texture_file.h"
#include "lights/environment_picture.h"
#include "lights/light.h"
#include "opaline/error.h"
#include "scene/scene_properties.h"
#include "scene/source_place.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

std::string contents_of(const Shape& shape, const std::string& path) {
  try {
    return mesh_contents(path);
  } catch (const Error& failure) {
    throw told_at(shape.place, failure);
  }
}

/// Adds colours read from files of spectra.
template <class Add>
void add_values(const Scene& scene, const Add& add) {
  if (!scene.wavelengths) return;
  const auto add_rgb = [&](const Rgb& value) { add(fmt::format("{} {} {}", value.x, value.y, value.z)); };
  for (const Light& light : scene.lights) add_rgb(emission(light));
  if (scene.backdrop) add_rgb(*scene.backdrop);
  for (const Shape& shape : scene.shapes) {
    add_rgb(shape.reflectance);
    add_rgb(shape.fuzz.color);
  }
  for (const Medium& medium : scene.media) {
    add_rgb(medium.tint);
    add_rgb(medium.base_color);
    add_rgb(medium.fuzz.color);
    const auto* const physical = std::get_if<PhysicalMedium>(&medium.coefficients);
    const auto* const artist = std::get_if<ArtistMedium>(&medium.coefficients);
    add_rgb(physical != nullptr ? physical->sigma_a : artist->subsurface_color);
    add_rgb(physical != nullptr ? physical->sigma_s_prime : artist->subsurface_radius);
  }
}

}  // namespace

// Hashes lengths before contents, so parts cannot be confused.
std::string scene_hash(const std::string& path, const std::vector<std::string>& overrides,
                       const Scene& scene) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return {};
  OIIO::SHA1 hash;
  const auto add = [&](const std::string& part) {
    const std::string length = std::to_string(part.size()) + ':';
    hash.append(length.data(), length.size());
    hash.append(part.data(), part.size());
  };
  std::set<std::string> seen;
  if (!is_asset_name(path)) {
    add(InputFile(path, "scene file").read_all());
  } else if (names_no_files(path)) {
    add(import_asset(path, "").text);  // with the material libraries of an OBJ
  } else {
    add(mesh_contents(path));
    seen.insert(path);
  }
  for (const std::string& text : overrides) add(text);
  for (const Shape& shape : scene.shapes)
    if (const auto* mesh = std::get_if<MeshFile>(&shape.source))
      if (seen.insert(mesh->path).second) add(contents_of(shape, mesh->path));
  for (const Shape& shape : scene.shapes)
    for (const Texture* texture : textures_of(scene, shape)) add(std::to_string(texture->source->hash()));
  for (const Light& light : scene.lights)
    if (const auto* environment = std::get_if<EnvironmentLight>(&light.source))
      add(std::to_string(environment->picture->hash()));
  add_values(scene, add);
  for (const Scene& other : scene.other_wavelengths) add_values(other, add);
  return hash.digest();
}

std::string direct_sums_key(const std::string& path, const std::vector<std::string>& overrides,
                            const Scene& scene) {
  std::vector<std::string> kept;
  for (const std::string& text : overrides)
    if (!text.starts_with("settings.entry_samples=") && !text.starts_with("settings.until_error="))
      kept.push_back(text);
  return scene_hash(path, kept, scene);
}

}  // namespace opaline
