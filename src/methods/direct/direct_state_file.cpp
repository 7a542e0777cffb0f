// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <filesystem>

#include "image/sums_file.h"
#include "methods/direct/direct.h"
#include "opaline/error.h"
#include "render/tile_renderer.h"

namespace opaline {
namespace {

constexpr const char* kPasses = "opaline:direct_passes";
constexpr const char* kScene = "opaline:direct_scene";

Image empty_state_image(const Scene& scene) {
  return empty_image(rendered_part(scene.film), scene.film,
                     {"sum.R", "sum.G", "sum.B", "root.R", "root.G", "root.B"});
}

std::string text_of(const Image& image, const std::string& key) {
  for (const auto& [name, value] : image.metadata)
    if (name == key) return value;
  return {};
}

// The image with its channels in this order, independent of the reader's order; empty unless exactly these
// are present.
std::vector<float> values_in_order(const Image& image, const std::vector<std::string>& channels) {
  std::vector<float> values;
  if (image.channels.size() != channels.size()) return values;
  std::vector<std::size_t> places;
  for (const std::string& channel : channels) {
    const auto place = std::ranges::find(image.channels, channel);
    if (place == image.channels.end()) return values;
    places.push_back(std::size_t(place - image.channels.begin()));
  }
  values.resize(image.pixels.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = image.pixels[i / places.size() * places.size() + places[i % places.size()]];
  return values;
}

}  // namespace

void write_direct_state(const std::string& path, const DirectState& state, const Scene& scene,
                        const std::string& scene_key) {
  Image image = empty_state_image(scene);
  require(image.pixels.size() == state.sums.size(), "the state belongs to another image");
  std::ranges::copy(state.sums, image.pixels.begin());
  image.metadata = {{kPasses, std::to_string(state.passes)}, {kScene, scene_key}};
  write_exr(path, image, false);
}

DirectState read_direct_state(const std::string& path, const Scene& scene, const std::string& scene_key) {
  DirectState state;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return state;
  const Image image = read_sums_file(path), expected = empty_state_image(scene);
  const std::string passes = text_of(image, kPasses);
  std::vector<float> sums = values_in_order(image, expected.channels);
  const auto [end, error] = std::from_chars(passes.data(), passes.data() + passes.size(), state.passes);
  if (passes.empty() || error != std::errc{} || end != passes.data() + passes.size() || sums.empty())
    throw bad_file(path, "does not hold the sums of a direct render", "a file that --resume wrote");
  if (text_of(image, kScene) != scene_key)
    throw bad_file(path, "the sums belong to another scene or other settings",
                   "the sums of this scene and settings, or a new file name");
  if (image.width != expected.width || image.height != expected.height)
    throw bad_file(path, "the sums belong to another image size");
  state.sums = std::move(sums);
  return state;
}

}  // namespace opaline
