// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/report.h"
#include "core/units.h"
#include "render/adaptive_rays.h"

namespace opaline {
namespace {

StageCost total_of(const std::vector<StageCost>& costs) {
  StageCost total{"total"};
  for (const StageCost& cost : costs) {
    total.wall_seconds += cost.wall_seconds;
    total.cpu_seconds += cost.cpu_seconds;
  }
  return total;
}

/// Mega-rays per CPU second; 0 without a measured time.
double mega_rays(std::uint64_t rays, double seconds) {
  return seconds > 0 ? 1e-6 * double(rays) / seconds : 0;
}

/// True if the cost is below the table's resolution.
bool is_nothing(const StageCost& cost) {
  constexpr double kShown = .0005;
  return cost.wall_seconds < kShown && cost.cpu_seconds < kShown;
}

/// Prints the cost of each stage. Stages computed by the trials belong to the cost of choosing and are named
/// there.
void print_costs(const Summary& summary) {
  std::vector<StageCost> shown = summary.costs;
  const auto choosing = std::ranges::find(shown, "choosing", &StageCost::stage);
  std::string of_trials;
  if (choosing != shown.end()) {
    const auto shading = std::ranges::find(choosing, shown.end(), "shading", &StageCost::stage);
    const auto left = std::stable_partition(choosing + 1, shading, std::not_fn(is_nothing));
    std::vector<std::string> names;
    std::transform(left, shading, std::back_inserter(names), [](const StageCost& c) { return c.stage; });
    if (!names.empty()) of_trials = fmt::format("   with {}", fmt::join(names, ", "));
    shown.erase(left, shading);
  }
  shown.push_back(total_of(summary.costs));
  for (const StageCost& cost : shown)
    write_line(stdout, fmt::format("{:<12}{:>9.3f} s wall{:>9.3f} s CPU{}", cost.stage, cost.wall_seconds,
                                   cost.cpu_seconds,
                                   cost.stage == "choosing"  ? of_trials
                                   : cost.stage == "bounces" ? "   re-entry included"
                                                             : ""));
}

/// Error due to settings; 0: unknown, or none.
double settings_error_of(const Summary& summary) {
  return summary.errors.predicted.value_or(summary.estimated_error);
}

/// Error of settings and model against random walks; none if one is unknown.
std::optional<double> whole_error(const Summary& summary) {
  if (!summary.model_error || !summary.unknown_models.empty() || !(settings_error_of(summary) > 0)) return {};
  return std::hypot(settings_error_of(summary), *summary.model_error);
}

std::string whole_error_text(const Summary& summary) {
  const std::optional<double> whole = whole_error(summary);
  return whole ? fmt::format("about {} against random walks{}, of which", short_percent(*whole),
                             summary.leaves_out_reentry ? " without re-entry" : "")
               : "";
}

/// Error due to settings: samples, tolerance, shadow rays, cells.
std::string settings_error_text(const Summary& summary) {
  const KnownErrors& errors = summary.errors;
  std::string text;
  if (errors.predicted)
    text = "predicted " + short_percent(*errors.predicted);
  else if (summary.estimated_error > 0)
    text = "estimated " + short_percent(summary.estimated_error);
  if (text.empty()) return text;
  if (const auto& measured = errors.measured; measured && measured->points > 0)
    text += fmt::format(", measured {} +- {:.1g} % at {} points", short_percent(measured->error),
                        100 * measured->standard_error, measured->points);
  return "settings " + text + " (mean relative error of the diffuse light, worst channel)";
}

/// Error due to the model of light transport.
std::string model_error_text(const Summary& summary) {
  std::string text;
  if (summary.model_error)
    text = fmt::format("model about {} (expected against random walks{}, rms, worst body and channel)",
                       short_percent(*summary.model_error),
                       summary.leaves_out_reentry ? " without re-entry" : "");
  if (summary.unknown_models.empty()) return text;
  const std::size_t count = summary.unknown_models.size();
  return text + (text.empty() ? "model: unknown for " : "; unknown for ") +
         (count == 1 ? summary.unknown_models[0] : fmt::format("{} bodies", count));
}

std::string camera_rays_text(const SpentCameraRays& rays) {
  std::string text =
      fmt::format("{:.1f} per pixel, at most {}; noise {:.3g} % (standard error, rms over the pixels)",
                  rays.mean, grouped(std::size_t(rays.most)), 100 * rays.noise);
  if (rays.missed_error)
    text += fmt::format("; the bound of {} rays per pixel ended it above {:.3g} %",
                        grouped(std::size_t(kMostAdaptiveRays)), 100 * *rays.missed_error);
  return text;
}

void print_text(const Summary& summary) {
  write_line(stdout, "");
  print_costs(summary);
  const auto row = [](const char* label, const std::string& text) {
    write_line(stdout, fmt::format("{:<12}{}", label, text));
  };
  row("memory", short_bytes(summary.peak_memory) + " at the peak");
  if (summary.samples > 0)
    row("samples",
        grouped(summary.samples) +
            (summary.queries > 0 ? fmt::format(", {} shading points", grouped(summary.queries)) : ""));
  if (summary.entry_samples > 0)
    row("samples",
        fmt::format("{} entry samples per pixel; noise {:.3g} % (standard error, rms over the pixels)",
                    grouped(summary.entry_samples), 100 * summary.direct_error));
  if (summary.walks > 0)
    row("walks", fmt::format("{} per sample, channel and light; noise {:.3g} % (standard error of a cell, "
                             "rms over the surface)",
                             grouped(summary.walks), 100 * summary.walk_noise));
  if (summary.camera_rays) row("camera rays", camera_rays_text(*summary.camera_rays));
  const char* label = "error";
  for (const std::string& text :
       {whole_error_text(summary), settings_error_text(summary), model_error_text(summary)})
    if (!text.empty()) row(std::exchange(label, ""), text);
  constexpr std::size_t kMostLines = 3;
  std::vector<LightNoise> worst = summary.noise;
  std::ranges::stable_sort(worst, std::greater(), &LightNoise::relative_error);
  if (worst.size() > kMostLines) worst.resize(kMostLines);
  for (const LightNoise& noise : worst)
    row("noise", fmt::format("irradiance from {} on {}: {} (standard error at a sample)", noise.light,
                             noise.group, short_percent(noise.relative_error)));
  if (summary.noise.size() > worst.size())
    row("", fmt::format("{} more with lower noise", summary.noise.size() - worst.size()));
  if (!summary.denoiser.empty())
    row("denoised",
        "after the errors above: specular and diffuse light, that of translucent shapes within twice "
        "its estimated error, by " +
            summary.denoiser);
  row("rays", fmt::format("{} in the shading pass: {:.3g} Mray per CPU second; {:.3g} in Embree alone",
                          grouped(summary.rays), mega_rays(summary.rays, summary.shading_seconds),
                          mega_rays(summary.rays, summary.embree_seconds)));
  if (summary.budget) {
    const SpentBudget& budget = *summary.budget;
    row("budget", fmt::format("{:.3g} s of CPU, {:.3g} % of {:.4g} s", budget.spent,
                              100 * budget.spent / budget.seconds, budget.seconds));
  }
  if (!summary.repeat_command.empty()) row("repeat with", summary.repeat_command);
  for (const std::string& output : summary.outputs) row("wrote", output);
}

Json budget_json(const SpentBudget& budget) {
  return {{"seconds", budget.seconds}, {"spent", budget.spent}};
}

Json done_json(const Summary& summary) {
  Json stages = Json::array(), noise = Json::array();
  for (const StageCost& cost : summary.costs) stages.push_back(stage_json(cost));
  for (const LightNoise& n : summary.noise)
    noise.push_back({{"group", n.group}, {"light", n.light}, {"relative_error", n.relative_error}});
  const StageCost total = total_of(summary.costs);
  Json json{{"wall_seconds", total.wall_seconds},
            {"cpu_seconds", total.cpu_seconds},
            {"stages", stages},
            {"peak_memory_bytes", summary.peak_memory},
            {"samples", summary.samples},
            {"queries", summary.queries},
            {"irradiance_noise", noise},
            {"denoiser", summary.denoiser},
            {"estimated_error", summary.estimated_error},
            {"errors", errors_json(summary.errors)},
            {"walks", summary.walks},
            {"walk_noise", summary.walk_noise},
            {"entry_samples", summary.entry_samples},
            {"direct_noise", summary.direct_error},
            {"shading_rays", summary.rays},
            {"shading_cpu_seconds", summary.shading_seconds},
            {"embree_cpu_seconds", summary.embree_seconds},
            {"outputs", summary.outputs}};
  if (summary.model_error) json["model_error"] = *summary.model_error;
  if (const std::optional<double> whole = whole_error(summary)) json["error_against_random_walks"] = *whole;
  if (!summary.unknown_models.empty()) json["bodies_of_unknown_model_error"] = summary.unknown_models;
  if (const auto& rays = summary.camera_rays) {
    json["camera_rays"] = {{"mean", rays->mean},
                           {"most", rays->most},
                           {"noise", rays->noise},
                           {"has_reached_error", !rays->missed_error}};
  }
  if (summary.budget) json["budget"] = budget_json(*summary.budget);
  if (!summary.repeat_command.empty()) json["again_by"] = summary.repeat_command;
  return json;
}

}  // namespace

Json errors_json(const KnownErrors& errors) {
  Json json = Json::object();
  if (errors.target) json["target"] = *errors.target;
  if (errors.predicted) json["predicted"] = *errors.predicted;
  if (errors.measured) {
    json["measured"] = errors.measured->error;
    json["standard_error"] = errors.measured->standard_error;
    json["reference_noise"] = errors.measured->noise;
    json["points"] = errors.measured->points;
  }
  return json;
}

Json stage_json(const StageCost& cost) {
  return {{"stage", cost.stage},
          {"wall_seconds", cost.wall_seconds},
          {"cpu_seconds", cost.cpu_seconds},
          {"system_seconds", cost.system_seconds},
          {"peak_memory_bytes", cost.peak_memory}};
}

void print_stage(const Log& log, const StageCost& cost) {
  if (!log.quiet) print_event(log, "stage", stage_json(cost));
}

void print_summary(const Log& log, const Summary& summary) {
  if (log.quiet) return;
  if (log.format == LogFormat::text) print_text(summary);
  print_event(log, "done", done_json(summary));
}

}  // namespace opaline
