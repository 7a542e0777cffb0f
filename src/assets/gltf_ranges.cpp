// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/gltf_ranges.h"

#include <fmt/format.h>

#include <limits>
#include <span>

namespace opaline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct FactorRange {
  const char* object;  ///< JSON pointer from the record to the object of the number
  const char* key;     ///< a number, or a list of numbers
  double low = 0, high = 1;
  bool is_above = false;     ///< the low end is excluded
  bool allows_zero = false;  ///< 0 is valid besides the range
};

// From the JSON schemas of glTF 2.0 and its extensions. The scale of a normal map may be negative there.
constexpr FactorRange kMaterialRanges[] = {
    {"", "emissiveFactor"},
    {"", "alphaCutoff", 0, kInfinity},
    {"/normalTexture", "scale", 0, kInfinity},
    {"/occlusionTexture", "strength"},
    {"/pbrMetallicRoughness", "baseColorFactor"},
    {"/pbrMetallicRoughness", "metallicFactor"},
    {"/pbrMetallicRoughness", "roughnessFactor"},
    {"/extensions/KHR_materials_anisotropy", "anisotropyStrength"},
    {"/extensions/KHR_materials_clearcoat", "clearcoatFactor"},
    {"/extensions/KHR_materials_clearcoat", "clearcoatRoughnessFactor"},
    {"/extensions/KHR_materials_diffuse_transmission", "diffuseTransmissionFactor"},
    {"/extensions/KHR_materials_diffuse_transmission", "diffuseTransmissionColorFactor"},
    {"/extensions/KHR_materials_dispersion", "dispersion", 0, kInfinity},
    {"/extensions/KHR_materials_emissive_strength", "emissiveStrength", 0, kInfinity},
    {"/extensions/KHR_materials_ior", "ior", 1, kInfinity, false, true},
    {"/extensions/KHR_materials_iridescence", "iridescenceFactor"},
    {"/extensions/KHR_materials_iridescence", "iridescenceIor", 1, kInfinity},
    {"/extensions/KHR_materials_iridescence", "iridescenceThicknessMinimum", 0, kInfinity},
    {"/extensions/KHR_materials_iridescence", "iridescenceThicknessMaximum", 0, kInfinity},
    {"/extensions/KHR_materials_pbrSpecularGlossiness", "diffuseFactor"},
    {"/extensions/KHR_materials_pbrSpecularGlossiness", "specularFactor"},
    {"/extensions/KHR_materials_pbrSpecularGlossiness", "glossinessFactor"},
    {"/extensions/KHR_materials_scatter", "scatterStrengthFactor"},
    {"/extensions/KHR_materials_scatter", "multiscatterColorFactor"},
    {"/extensions/KHR_materials_scatter", "scatterAnisotropy", -1, 1},
    {"/extensions/KHR_materials_sheen", "sheenColorFactor"},
    {"/extensions/KHR_materials_sheen", "sheenRoughnessFactor"},
    {"/extensions/KHR_materials_specular", "specularFactor"},
    {"/extensions/KHR_materials_specular", "specularColorFactor", 0, kInfinity},
    {"/extensions/KHR_materials_transmission", "transmissionFactor"},
    {"/extensions/KHR_materials_volume", "thicknessFactor", 0, kInfinity},
    {"/extensions/KHR_materials_volume", "attenuationDistance", 0, kInfinity, true},
    {"/extensions/KHR_materials_volume", "attenuationColor"},
    {"/extensions/KHR_materials_volume_scatter", "multiscatterColor"},
    {"/extensions/KHR_materials_volume_scatter", "scatterAnisotropy", -1, 1},
};

constexpr FactorRange kLightRanges[] = {
    {"", "color"},
    {"", "intensity", 0, kInfinity},
    {"", "range", 0, kInfinity, true},
};

bool is_within(double number, const FactorRange& range) {
  if (range.allows_zero && number == 0) return true;
  return number <= range.high && (range.is_above ? number > range.low : number >= range.low);
}

std::string text_of(const FactorRange& range) {
  if (range.high < kInfinity) return fmt::format("{} to {}", range.low, range.high);
  return fmt::format("{} {}{}", range.is_above ? "above" : "at least", range.low,
                     range.allows_zero ? ", or 0" : "");
}

/// Clamps a number, or those of a list. Other types are left to the reader of the value.
bool clamp_numbers(Json& value, const FactorRange& range) {
  if (value.is_array()) {
    bool is_changed = false;
    for (Json& element : value)
      if (element.is_number()) is_changed |= clamp_numbers(element, range);
    return is_changed;
  }
  if (!value.is_number() || is_within(value.get<double>(), range)) return false;
  value = std::clamp(value.get<double>(), range.low, range.high);
  return true;
}

/// "materials[3].extensions.KHR_materials_ior.ior"
std::string place_of(const std::string& record, const FactorRange& range) {
  std::string object = range.object;
  std::ranges::replace(object, '/', '.');
  return record + object + '.' + range.key;
}

Json within_ranges(const GltfModel& gltf, const char* list, std::size_t index,
                   std::span<const FactorRange> ranges, AssetScene& scene) {
  const std::string record = gltf.record(list, index).place();
  Json json = gltf.lists.find(list)->second[index];
  for (const FactorRange& range : ranges) {
    const Json::json_pointer object(range.object);
    if (!json.contains(object) || !json[object].contains(range.key)) continue;
    Json& value = json[object][range.key];
    const std::string given = value.dump();
    if (!clamp_numbers(value, range)) continue;
    const std::string what = place_of(record, range) + " is out of range (expected " + text_of(range) +
                             ", got " + given + "): uses " + (range.is_above ? "the default" : value.dump());
    if (range.is_above) json[object].erase(range.key);
    scene.warn(gltf.path, what);
  }
  return json;
}

}  // namespace

Json material_within_ranges(const GltfModel& gltf, std::size_t index, AssetScene& scene) {
  return within_ranges(gltf, "materials", index, kMaterialRanges, scene);
}

Json light_within_ranges(const GltfModel& gltf, std::size_t index, AssetScene& scene) {
  return within_ranges(gltf, "lights", index, kLightRanges, scene);
}

}  // namespace opaline
