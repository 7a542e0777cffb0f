// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/profile_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmark/page.h"
#include "benchmark/results_json.h"
#include "core/log.h"
#include "opaline/enumerations.h"
#include "transport/fresnel.h"
#include "transport/point_source.h"

namespace opaline {
namespace {

/// Radiance by cosine of exit over a Lambert emitter's, as every model has it.
Json fresnel_json(double eta) {
  const double entered = 1 - average_reflectance_outside(eta);
  Json points = Json::array();
  for (int i = 0; i <= 100; ++i)
    points.push_back(
        {{"x", i / 100.}, {"y", (eta == 1 ? 1 : fresnel_transmittance(i / 100., eta)) / entered}});
  return points;
}

/// Fluence around a point source in an infinite medium, of two kinds of diffusion over the exact one.
void add_point_source(const HomogeneousMedium& medium, double length, Json& channel) {
  const HomogeneousMedium reduced{medium.sigma_a, (1 - medium.g) * medium.sigma_s, 0, 1};
  for (int i = 0; i <= 60; ++i) {
    const double r = .05 * length * std::pow(1000, i / 60.), exact = point_source_fluence(reduced, r);
    if (!(exact > 0)) break;
    channel["classical"].push_back({{"x", r}, {"y", diffusion_point_fluence(reduced, r) / exact}});
    channel["grosjean"].push_back({{"x", r}, {"y", grosjean_point_fluence(reduced, r) / exact}});
  }
}

Json channel_json(const ProfiledChannel& channel) {
  const HomogeneousMedium& medium = channel.medium;
  const double length = medium.reduced_mean_free_path();
  Json json{
      {"name", channel.name},
      {"sigma_a", medium.sigma_a},
      {"sigma_s", medium.sigma_s},
      {"g", medium.g},
      {"reduced_mean_free_path", length},  // not finite: null
      {"diffuse_mean_free_path", medium.sigma_a > 0 ? std::sqrt(length / (3 * medium.sigma_a)) : INFINITY},
      {"collisions", channel.diffuse.collisions},
      {"walks", channel.diffuse.walks},
      {"fresnel", fresnel_json(medium.eta)}};
  if (medium.sigma_s > 0) add_point_source(medium, length, json);
  return json;
}

}  // namespace

std::string shape_words(const ProfileReport& report) {
  return report.is_slab() ? fmt::format("slab of {:.4g} mm", report.request.thickness) : "half space";
}

std::string walked_text(const WalkedValue& value, const char* between) {
  const int digits = value.error > 0 ? std::clamp(1 - int(std::floor(std::log10(value.error))), 3, 7) : 4;
  return fmt::format("{:.{}f}{}{:.{}f}", value.value, digits, between, value.error, digits);
}

Json profile_page_data(const ProfileReport& report) {
  Json data{{"command", "profile"},
            {"medium", report.request.name},
            {"shape", shape_words(report)},
            {"is_slab", report.is_slab()},
            {"eta", report.request.eta},
            {"notes", report.notes},
            {"totals", rows_json(totals_table(report))},
            {"rings", rows_json(rings_table(report))},
            {"angles", rows_json(angles_table(report))}};
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind)
    data["models"].push_back({kProfileNames[kind], kProfileSources[kind]});
  for (const ProfiledChannel& channel : report.channels) data["channels"].push_back(channel_json(channel));
  return data;
}

std::string to_page(const ProfileReport& report) {
  return page_of(profile_page_data(report));
}

}  // namespace opaline
