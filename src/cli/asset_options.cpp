// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/asset_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>

#include "assets/import_asset.h"
#include "geometry/world.h"
#include "input/load_scene.h"
#include "input/presets.h"
#include "opaline/error.h"

namespace opaline {
namespace {

/// Largest side of the box around the shapes of the file, scene units. Excludes shapes appended by overrides.
double extent_of(const std::string& path, const std::vector<std::string>& overrides) {
  if (is_asset_name(path) && overrides.empty()) return import_asset(path, path).defaults.extent;
  Scene scene = load_scene(path, overrides);
  const bool appends =
      std::ranges::any_of(overrides, [](const std::string& text) { return text.starts_with("shapes.+"); });
  if (const std::size_t own = appends ? load_scene(path).shapes.size() : 0; own > 0)
    scene.shapes.resize(std::min(own, scene.shapes.size()));
  Bounds all;
  for (const Bounds& box : make_world(scene).boxes) {
    all.low = component_min(all.low, box.low);
    all.high = component_max(all.high, box.high);
  }
  return scene.shapes.empty() ? 0 : max_component(all.high - all.low) / scene.mm_per_unit;
}

/// False for assets and files without a scene; reading them reports the latter.
bool has_medium(const std::string& path, const std::string& name) {
  if (is_asset_name(path)) return false;
  try {
    const auto scene = nlohmann::json::parse(merged_scene(read_scene_text(path), path, {}));
    return scene.contains("media") && scene.at("media").contains(name);
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

std::vector<std::string> medium_overrides(const std::string& scene, const std::string& option) {
  const std::size_t equals = option.rfind('=');
  const std::string medium = option.substr(equals + 1),  // npos + 1 is 0
      shape = equals == option.npos ? "*" : option.substr(0, equals);
  std::vector<std::string> overrides;
  const auto has = [&](std::span<const Preset> all) {
    return std::ranges::find(all, medium, &Preset::name) != all.end();
  };
  if (has(presets()) && !has_medium(scene, medium)) {
    overrides.push_back(fmt::format("media.{0}.preset={0}", medium));
    if (has(measured_presets()))
      overrides.push_back(fmt::format("media.{}.specular_roughness={}", medium, kMeasuredRoughness));
  }
  overrides.push_back(fmt::format("shapes.{}.medium={}", shape, medium));
  return overrides;
}

std::string size_override(const std::string& scene, const std::vector<std::string>& overrides, double size) {
  const double extent = extent_of(scene, overrides);
  if (!(extent > 0)) throw bad_file(scene, "has no size to scale to --size", "a shape");
  return fmt::format("mm_per_unit={}", size / extent);
}

}  // namespace opaline
