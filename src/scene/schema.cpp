// SPDX-License-Identifier: GPL-3.0-or-later
#include "schema.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "json_tree.h"

namespace opaline {
namespace {

struct Section {
  std::string_view name;
  std::vector<std::string_view> keys;
};

const std::vector<Section>& sections() {
  static const std::vector<Section> table{
      {"scene", {"mm_per_unit", "media", "shapes", "lights", "surroundings", "camera", "film", "settings"}},
      {"medium",
       {"preset", "sigma_a", "sigma_s_prime", "sigma_s", "g", "subsurface_color", "subsurface_radius",
        "subsurface_radius_scale", "subsurface_scatter_anisotropy", "specular_ior", "eta", "profile"}},
      {"shape",
       {"name", "file", "sphere", "box", "quad", "slab", "torus", "fill_holes", "fit_size", "transform",
        "normals", "medium", "reflectance", "group"}},
      {"shape.sphere", {"center", "radius"}},
      {"shape.box", {"low", "high"}},
      {"shape.quad", {"corner", "u", "v"}},
      {"shape.slab", {"center", "width", "depth", "thickness"}},
      {"shape.torus", {"center", "major_radius", "minor_radius"}},
      {"shape.transform", {"translate", "scale", "rotate", "matrix"}},
      {"shape.transform.rotate", {"axis", "degrees"}},
      {"light.point", {"type", "name", "position", "intensity"}},
      {"light.directional", {"type", "name", "direction", "irradiance"}},
      {"light.sphere", {"type", "name", "center", "radius", "radiance"}},
      {"light.quad", {"type", "name", "corner", "u", "v", "radiance"}},
      {"camera", {"position", "look_at", "up", "field_of_view"}},
      {"film", {"resolution", "crop", "samples_per_pixel", "filter", "pixel_type", "exposure"}},
      {"settings",
       {"method", "evaluator", "tolerance", "instruction_set", "max_solid_angle", "near_field",
        "near_irradiance", "sample_spacing", "samples", "max_samples", "light_samples", "entry_strategy",
        "entry_samples", "until_error", "seed", "reference_frame"}},
  };
  return table;
}

/// Insertions, deletions, substitutions and swaps of neighbours that turn a into b (optimal string
/// alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::span<const std::string_view> section_keys(std::string_view section) {
  for (const Section& s : sections())
    if (s.name == section) return s.keys;
  return {};
}

std::vector<std::string> all_known_keys() {
  std::vector<std::string> keys;
  for (const Section& section : sections())
    for (const std::string_view key : section.keys)
      keys.push_back(std::string(section.name) + '.' + std::string(key));
  return keys;
}

namespace {

std::string suggestion(std::string_view name) {
  return name.empty() ? "" : " (did you mean '" + printable(name) + "'?)";
}

/// The candidate that is spelt almost alike, or empty.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
  constexpr std::size_t longest = 64;  // a name may be megabytes long; then nothing is near it
  std::string_view nearest;
  std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string_view candidate : candidates) {
    if (name.size() > longest || candidate.size() > longest) continue;
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

/// The sections that stand once in a scene, so that their keys have one path.
constexpr std::array<std::string_view, 3> kSingleSections{"camera", "film", "settings"};

/// Path of a key in one of them that is called like this, or, if `almost`, spelt almost alike; or empty.
std::string path_elsewhere(std::string_view key, bool almost) {
  for (const std::string_view section : kSingleSections) {
    const std::span<const std::string_view> keys = section_keys(section);
    const bool is_there = std::ranges::find(keys, key) != keys.end();
    const std::string_view found = is_there ? key : almost ? nearest_name(key, keys) : std::string_view();
    if (!found.empty()) return std::string(section) + '.' + std::string(found);
  }
  return {};
}

}  // namespace

std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates) {
  return suggestion(nearest_name(name, candidates));
}

std::string did_you_mean_key(std::string_view name, std::string_view section) {
  const std::span<const std::string_view> keys = section_keys(section);
  // Keys of a shape, a light or a medium are not mixed up with the others: only their names are alike.
  const bool may_be_elsewhere =
      section == "scene" || std::ranges::find(kSingleSections, section) != kSingleSections.end();
  if (!may_be_elsewhere) return did_you_mean(name, keys);
  const std::string exact = path_elsewhere(name, false);
  if (!exact.empty()) return suggestion(exact);
  const std::string_view near = nearest_name(name, keys);
  return near.empty() ? suggestion(path_elsewhere(name, true)) : suggestion(near);
}

std::string join(std::span<const std::string_view> names) {
  std::string all;
  for (const std::string_view name : names) all += (all.empty() ? "" : ", ") + std::string(name);
  return all;
}

}  // namespace opaline
