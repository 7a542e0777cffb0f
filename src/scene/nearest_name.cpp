// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/scene/nearest_name.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>
#include <utility>
#include <vector>

#include "opaline/scene/json_tree.h"
#include "opaline/scene/schema.h"

namespace opaline {
namespace {

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

std::string suggestion(std::string_view name) {
  return name.empty() ? "" : " (did you mean '" + printable(name) + "'?)";
}

// What other programs call it.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kOtherWords{
    {{"rect", "quad"},
     {"rectangle", "quad"},
     {"area", "quad"},
     {"sun", "directional"},
     {"distant", "directional"},
     {"dome", "environment"},
     {"hdri", "environment"},
     {"infinite", "environment"}}};

/// The candidate that is spelt almost alike or that another program calls so, or empty.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
  for (const auto& [other, own] : kOtherWords)
    if (name == other && std::ranges::find(candidates, own) != candidates.end()) return own;
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

std::string did_you_mean_file(const std::string& path) {
  constexpr std::size_t most = 10000;  // files of a folder; in a larger one nothing is looked for
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
  const std::string near(nearest_name(given.filename().string(), views));
  // The project's own scenes have a script beside them that fetches their assets.
  const std::filesystem::path script = folder.parent_path() / "gallery";
  if (near.empty() && folder.filename() == "assets" && std::filesystem::is_regular_file(script, failure))
    return " (" + printable(script.string()) + " fetches the assets of the scenes beside it)";
  return suggestion(near.empty() ? near : (folder / near).string());
}

}  // namespace opaline
