// SPDX-License-Identifier: GPL-3.0-or-later
#include "values/nearest_name.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>
#include <utility>
#include <vector>

#include "core/lower_case.h"
#include "values/json_tree.h"
#include "values/key_info.h"

namespace opaline {
namespace {

/// Insertions, deletions, substitutions and swaps of neighbours turning a into b (optimal string
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

using Names = std::vector<std::string>;

std::string suggestion(const Names& names) {
  if (names.empty()) return {};
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : " or '") + printable(name) + '\'';
  return " (did you mean " + text + "?)";
}

struct OtherWord {
  std::string_view word;
  std::array<std::string_view, 7> own = {};
};

// Other programs' names of options, keys and choices.
constexpr OtherWord kOtherWords[] = {
    {"--cores", {"--threads"}},
    {"--error", {"--target-error", "--until-error"}},
    {"--jobs", {"--threads"}},
    {"--noise", {"--denoise", "--until-error"}},
    {"--quality", {"--target-error", "--spp"}},
    {"--verbose", {"--log"}},
    {"--workers", {"--threads"}},
    {"absorption", {"sigma_a"}},
    {"albedo", {"subsurface_color", "base_color", "reflectance"}},
    {"area", {"quad"}},
    {"background", {"surroundings"}},
    {"base_color", {"reflectance"}},
    {"brightness", {"intensity", "radiance", "irradiance", "strength"}},
    {"burley", {"normalized_diffusion"}},
    {"color",
     {"subsurface_color", "base_color", "reflectance", "intensity", "radiance", "irradiance", "strength"}},
    {"colour",
     {"subsurface_color", "base_color", "reflectance", "intensity", "radiance", "irradiance", "strength"}},
    {"diffuse", {"base_color", "reflectance"}},
    {"distant", {"directional"}},
    {"dome", {"environment"}},
    {"emission", {"radiance"}},
    {"eye", {"position"}},
    {"filename", {"file"}},
    {"filmic", {"agx"}},
    {"fov", {"field_of_view"}},
    {"hdri", {"environment"}},
    {"height", {"resolution"}},
    {"infinite", {"environment"}},
    {"integrator", {"method"}},
    {"intensity", {"radiance", "irradiance", "strength"}},
    {"ior", {"specular_ior"}},
    {"jensen", {"dipole"}},
    {"location", {"position"}},
    {"material", {"medium", "preset"}},
    {"materials", {"media"}},
    {"mean_free_path", {"subsurface_radius"}},
    {"medium", {"preset"}},
    {"mesh", {"file"}},
    {"metallic", {"metalness"}},
    {"mfp", {"subsurface_radius"}},
    {"objects", {"shapes"}},
    {"origin", {"position"}},
    {"path", {"volume"}},
    {"pos", {"position", "center", "corner", "transform"}},
    {"position", {"center", "corner", "transform"}},
    {"power", {"intensity", "radiance", "irradiance", "strength"}},
    {"radiance", {"intensity", "irradiance", "strength"}},
    {"random_walk", {"volume"}},
    {"rect", {"quad"}},
    {"rectangle", {"quad"}},
    {"reflectance", {"base_color", "subsurface_color"}},
    {"rotate", {"transform"}},
    {"rotation", {"transform"}},
    {"rough", {"specular_roughness"}},
    {"roughness", {"specular_roughness"}},
    {"samples", {"samples_per_pixel"}},
    {"scale", {"transform"}},
    {"scattering", {"sigma_s"}},
    {"sheen", {"fuzz_weight"}},
    {"sheen_color", {"fuzz_color"}},
    {"sheen_roughness", {"fuzz_roughness"}},
    {"size", {"resolution"}},
    {"spp", {"samples_per_pixel"}},
    {"strength", {"intensity", "radiance", "irradiance"}},
    {"sun", {"directional"}},
    {"target", {"look_at"}},
    {"tonemap", {"view"}},
    {"translate", {"transform"}},
    {"velvet", {"fuzz_weight"}},
    {"width", {"resolution"}},
    {"world", {"surroundings"}},
};

/// Candidates with this name in another program.
Names named_otherwise(std::string_view name, std::span<const std::string_view> candidates) {
  Names found;
  for (const auto& [word, own] : kOtherWords)
    for (const std::string_view key : own)
      if (name == word && std::ranges::find(candidates, key) != candidates.end()) found.emplace_back(key);
  return found;
}

/// The one candidate of similar spelling in any case, or none.
Names nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
  constexpr std::size_t longest = 64;  // longer names, possibly megabytes, match nothing
  Names nearest;
  std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string_view candidate : candidates) {
    if (name.size() > longest || candidate.size() > longest) continue;
    const std::size_t distance = edit_distance(in_lower_case(name), in_lower_case(candidate));
    if (distance < least && distance < candidate.size()) {
      least = distance;
      nearest = {std::string(candidate)};
    }
  }
  return nearest;
}

/// Candidates ending with this word, `specular_roughness` for `roughness`, unless there are many.
Names longer_names(std::string_view name, std::span<const std::string_view> candidates) {
  constexpr std::size_t most = 3;
  Names found;
  for (const std::string_view candidate : candidates)
    if (!name.empty() && candidate.ends_with('_' + std::string(name))) found.emplace_back(candidate);
  return found.size() <= most ? found : Names{};
}

Names similar_names(std::string_view name, std::span<const std::string_view> candidates) {
  for (const auto& look : {named_otherwise, nearest_name, longer_names})
    if (Names found = look(name, candidates); !found.empty()) return found;
  return {};
}

/// Keys with a word beginning with this name, `position` for `pos`, preferably their first word; none if there
/// are many.
Names abbreviated_keys(std::string_view name, std::span<const std::string_view> keys) {
  constexpr std::size_t most = 3;
  if (name.empty()) return {};
  Names found;
  for (const std::string_view key : keys)
    if (key.starts_with(name)) found.emplace_back(key);
  if (found.empty())
    for (const std::string_view key : keys)
      if (key.find('_' + std::string(name)) != key.npos) found.emplace_back(key);
  return found.size() <= most ? found : Names{};
}

Names similar_keys(std::string_view name, std::span<const std::string_view> keys) {
  const Names found = similar_names(name, keys);
  return found.empty() ? abbreviated_keys(name, keys) : found;
}

/// Sections occurring once in a scene, so their keys have one path.
constexpr std::array<std::string_view, 4> kSingleSections{"camera", "film", "settings",
                                                          "settings.laboratory"};

/// Lists whose elements have these keys.
struct ListSection {
  std::string_view section, path;
};
constexpr std::array<ListSection, 2> kListSections{{{"medium", "media.NAME."}, {"shape", "shapes.NAME."}}};

/// Paths of the keys with this name, or with it in another program.
Names paths_of(std::string_view key) {
  Names paths;
  for (const std::string_view section : kSingleSections) {
    const std::span<const std::string_view> keys = section_keys(section);
    const bool is_there = std::ranges::find(keys, key) != keys.end();
    for (const std::string& name : is_there ? Names{std::string(key)} : named_otherwise(key, keys))
      paths.push_back(std::string(section) + '.' + name);
  }
  return paths;
}

/// The path of a key of similar spelling, or none.
Names nearest_path(std::string_view key) {
  for (const std::string_view section : kSingleSections)
    for (const std::string& name : nearest_name(key, section_keys(section)))
      return {std::string(section) + '.' + name};
  return {};
}

/// The path of a key beginning with this name, or none.
Names abbreviated_path(std::string_view name) {
  constexpr std::size_t fewest = 3;  // letters of an abbreviation across sections
  if (name.size() < fewest) return {};
  Names paths;
  for (const std::string_view section : kSingleSections)
    for (const std::string_view key : section_keys(section))
      if (key.starts_with(name)) paths.push_back(std::string(section) + '.' + std::string(key));
  return paths.size() == 1 ? paths : Names{};
}

/// A key by this name, or those that look(name, keys) finds.
template <class Look>
Names key_or(std::string_view name, std::span<const std::string_view> keys, const Look& look) {
  return std::ranges::find(keys, name) != keys.end() ? Names{std::string(name)} : look(name, keys);
}

/// Paths of keys of media and shapes matching a name at the top level.
Names paths_in_lists(std::string_view key) {
  for (const ListSection& list : kListSections) {
    Names found = key_or(key, section_keys(list.section), similar_keys);
    for (std::string& name : found) name.insert(0, list.path);
    if (!found.empty()) return found;
  }
  return {};
}

/// Paths of all keys of media and shapes with this name, or with it in another program.
Names same_paths_in_lists(std::string_view key) {
  Names paths;
  for (const ListSection& list : kListSections)
    for (const std::string& name : key_or(key, section_keys(list.section), named_otherwise))
      paths.push_back(std::string(list.path) + name);
  return paths;
}

}  // namespace

std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates) {
  return suggestion(similar_names(name, candidates));
}

std::string did_you_mean_key(std::string_view name, std::string_view section) {
  const std::span<const std::string_view> keys = section_keys(section);
  // Keys of shapes, lights and media have similar names, but are not confused with others.
  const bool may_be_elsewhere =
      section == "scene" || std::ranges::find(kSingleSections, section) != kSingleSections.end();
  if (!may_be_elsewhere) return suggestion(similar_keys(name, keys));
  for (const Names& found :
       {paths_of(name), similar_keys(name, keys), nearest_path(name), abbreviated_path(name)})
    if (!found.empty()) return suggestion(found);
  return section == "scene" ? suggestion(paths_in_lists(name)) : "";
}

std::vector<std::string> similar_key_paths(std::string_view name) {
  for (const Names& found : {paths_of(name), same_paths_in_lists(name), nearest_path(name)})
    if (!found.empty()) return found;
  return {};
}

const KeyInfo& key_at(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  for (const ListSection& list : kListSections)
    if (path.starts_with(list.path)) return key_info(list.section, path.substr(dot + 1));
  return key_info(path.substr(0, dot), path.substr(dot + 1));
}

std::string did_you_mean_file(const std::string& path) {
  constexpr std::size_t most = 10000;  // maximum files of a searched folder
  const std::filesystem::path given(path), folder = given.parent_path();
  std::vector<std::string> names;
  std::error_code failure;
  std::filesystem::directory_iterator file(folder.empty() ? "." : folder, failure);
  for (; !failure && file != std::filesystem::directory_iterator(); file.increment(failure)) {
    if (names.size() == most) return {};
    names.push_back(file->path().filename().string());
  }
  std::ranges::sort(names);  // folders list their files in no order
  const std::vector<std::string_view> views(names.begin(), names.end());
  Names near = nearest_name(given.filename().string(), views);
  const std::string stem = given.stem().string();  // a common extension makes no names similar
  if (!near.empty() &&
      edit_distance(in_lower_case(stem), in_lower_case(std::filesystem::path(near.front()).stem().string())) >
          std::max<std::size_t>(1, stem.size() / 3))
    near.clear();
  // The example scenes have a script that fetches their assets.
  const std::filesystem::path script = folder.parent_path() / "gallery";
  if (near.empty() && folder.filename() == "assets" && std::filesystem::is_regular_file(script, failure))
    return " (" + printable(script.string()) + " downloads the assets of these scenes)";
  return near.empty() ? "" : suggestion({(folder / near.front()).string()});
}

}  // namespace opaline
