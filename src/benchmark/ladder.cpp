// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/ladder.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "input/schema.h"

namespace opaline {
namespace {

/// Rungs differing in one setting.
struct Series {
  std::string method, evaluator, knob;
  std::vector<std::string> values, quick_values;
};

std::string scaled(std::size_t samples, double factor) {
  return std::to_string(std::max<std::size_t>(1, std::size_t(factor * double(samples))));
}

/// A new evaluator or knob is a line here. A series without a knob has one value, "".
std::vector<Series> all_series(std::size_t samples) {
  const std::string quarter = scaled(samples, .25), planned = scaled(samples, 1),
                    fourfold = scaled(samples, 4);
  return {
      {"lambert", "", "", {""}, {""}},
      {"preintegrated", "", "", {""}, {""}},
      {"image_space", "", "", {""}, {""}},
      {"hierarchical", "", "", {""}, {""}},
      {"hierarchical", "dual_tree", "tolerance", {"0.1", "0.02", "0.005", "0.001"}, {"0.02"}},
      {"hierarchical", "surface_cache", "tolerance", {"0.02", "0.005"}, {"0.02"}},
      {"hierarchical", "classic", "max_solid_angle", {"0.4", "0.1", "0.05", "0.02"}, {"0.4", "0.1"}},
      {"hierarchical", "brute_force", "", {""}, {}},
      {"hierarchical", "dual_tree", "samples", {quarter, planned, fourfold}, {quarter}},
      {"hierarchical", "", "bounces", {"0"}, {"0"}},
      {"direct", "", "entry_samples", {"16", "64", "256"}, {"16"}},
  };
}

}  // namespace

std::string name_of(const Rung& rung) {
  std::string name = rung.method;
  if (!rung.evaluator.empty()) name += ' ' + rung.evaluator;
  if (!rung.knob.empty()) name += ' ' + rung.knob + '=' + rung.value;
  return name;
}

std::vector<std::string> overrides_of(const Rung& rung, std::span<const std::string> media) {
  std::vector<std::string> overrides{"settings.method=" + rung.method};
  if (!rung.evaluator.empty()) overrides.push_back("settings.evaluator=" + rung.evaluator);
  if (rung.of_media)
    for (const std::string& medium : media)
      overrides.push_back("media." + medium + '.' + rung.knob + '=' + rung.value);
  else if (!rung.knob.empty())
    overrides.push_back(settings_path(rung.knob) + '=' + rung.value);
  return overrides;
}

std::vector<Rung> ladder(const LadderInput& input) {
  std::vector<Rung> rungs;
  for (const Series& series : all_series(input.planned_samples)) {
    // Without translucent shapes there are no samples, and nothing but diffuse reflection.
    constexpr std::array kOfBodies{"hierarchical", "preintegrated", "image_space"};
    if (input.planned_samples == 0 && std::ranges::find(kOfBodies, series.method) != kOfBodies.end())
      continue;
    if (!input.bounces && series.knob == "bounces") continue;
    for (const std::string& value : input.quick ? series.quick_values : series.values)
      rungs.push_back({series.method, series.evaluator, series.knob, value});
  }
  return rungs;
}

std::vector<Rung> truth_ladder(bool quick) {
  std::vector<Rung> rungs;
  for (const char* method : {"lambert", "preintegrated", "image_space", "hierarchical"})
    rungs.push_back({method, "", "", ""});
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind)
    if (ProfileKind(kind) != ProfileKind::directional_dipole)  // `direct` only
      rungs.push_back({"hierarchical", "", "profile", std::string(kProfileNames[kind]), true});
  for (const char* cells : {"3", "2", "1"})
    if (!quick || cells == std::string_view("2"))
      rungs.push_back({"volume_diffusion", "", "cell_size", cells});
  return rungs;
}

}  // namespace opaline
