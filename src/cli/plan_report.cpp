// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bodies/plan_texts.h"
#include "cli/report.h"
#include "core/units.h"
#include "lights/light.h"
#include "plan/across_air.h"
#include "plan/choose_models.h"
#include "plan/expected_seconds.h"
#include "plan/make_plan.h"
#include "render/adaptive_rays.h"
#include "scene/names.h"
#include "subsurface/method.h"
#include "values/nearest_name.h"
#include "values/override_key.h"

namespace opaline {
namespace {

constexpr double kLong = 5;             // seconds
constexpr std::size_t kMostShown = 50;  // bodies

using Paragraphs = std::vector<std::string>;

/// A row with a label begins a paragraph, one without continues it.
void add_row(Paragraphs& paragraphs, const std::string& label, const std::string& text) {
  const std::string row = fmt::format("{:<12}{}", label, text);
  if (label.empty())
    paragraphs.back() += '\n' + row;
  else
    paragraphs.push_back(row);
}

std::string counted(std::size_t count, const std::string& noun) {
  return fmt::format("{} {}{}", grouped(count), noun, count == 1 ? "" : "s");
}

std::string picture_text(const Scene& scene) {
  const Film& film = scene.film;
  std::string text = fmt::format("{} x {} pixels, ", film.resolution[0], film.resolution[1]);
  if (film.crop) {
    const auto& [x0, y0, x1, y1] = *film.crop;
    text += fmt::format("crop x {} to {}, y {} to {}, ", x0, x1 - 1, y0, y1 - 1);
  }
  text +=
      has_adaptive_rays(scene)
          ? fmt::format("{} to {} camera rays per pixel, until the noise is {:.3g} %", kFewestAdaptiveRays,
                        grouped(std::size_t(kMostAdaptiveRays)), 100 * *scene.settings.until_error)
          : counted(std::size_t(film.samples_per_pixel), "camera ray") + " per pixel";
  return text + fmt::format(", {} filter", name_of(film.filter));
}

std::string lights_text(const std::vector<Light>& lights) {
  std::string text;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const Light& light = lights[l];
    if (l > 0 && share_rays(lights[l - 1], light)) continue;
    const std::string kind(name_of(light.source));
    text += (text.empty() ? "" : ", ") + light.name + (light.name == kind ? "" : " (" + kind + ")");
  }
  return text.empty() ? "none" : text;
}

/// Adds profile and error, for methods using a radial profile.
void add_model(Paragraphs& plan, const Scene& scene, const BodyPlan& group, double across_air) {
  if (method_of(group.method).uses_radial_profile()) add_row(plan, "", "profile " + model_text(group.model));
  const std::string error = model_error_text(group.model, group.method, !leaves_out_reentry(scene, group));
  if (!error.empty()) add_row(plan, "", error);
  constexpr double kWorthSaying = .02;
  if (across_air > kWorthSaying)
    add_row(plan, "",
            fmt::format("the radial profile carries {:.0f} % of its light across air gaps between facing "
                        "surfaces; --method volume_diffusion does not",
                        100 * across_air));
}

void add_group(Paragraphs& plan, const Scene& scene, const World& world, const BodyPlan& group) {
  add_row(plan, "translucent",
          fmt::format("{} of {}: {:.4g} mm^2, {}", group.name, scene.media[group.medium].name, group.area,
                      mean_free_path_text(scene, group)));
  add_model(plan, scene, group, share_across_air(scene, world, group));
  if (!method_of(scene.settings.method).needs_samples()) return;
  add_row(plan, "", samples_text(group));
}

/// Hint for an asset without a translucent material, as few formats have one.
std::string marble_text(const Scene& scene, const World& world) {
  if (scene.translation.empty() || scene.shapes.empty() || !scene.media.empty()) return {};
  constexpr double kHandful = 50;  // mm
  constexpr double kMuch = 500;    // mm: a thousand mean free paths of marble
  const Shape& shape = scene.shapes[0];
  // OBJ, PLY and OFF files have no unit: a figurine in metres is as large as a person, and its size decides
  // its translucency. STL files are in mm by custom.
  const double diagonal = world.diagonal * world.unit;
  const bool is_unitless =
      scene.mm_per_unit == 1 &&
      std::ranges::any_of(std::array{".obj", ".ply", ".off"},
                          [&](const char* extension) { return scene.file.ends_with(extension); });
  const bool has_lights = std::ranges::any_of(scene.lights, is_delta);  // brightness depends on the unit
  const bool has_unit = !(diagonal > 0) || !(is_unitless || (diagonal > kMuch && !has_lights));
  const bool is_alone = scene.shapes.size() == 1;
  return fmt::format("; --medium {}marble{} gives {} the medium marble{}{}",
                     is_alone ? "" : override_key(shape.name, 0) + '=',
                     has_unit ? "" : fmt::format(" --size {}mm", kHandful), is_alone ? "it" : shape.name,
                     has_unit ? "" : fmt::format(", {} mm across", kHandful),
                     shape.reflectance_texture ? ", without its texture" : "");
}

/// Fewer samples for large bodies, if they save much of the time.
std::string fewer_samples_text(const Scene& scene, const World& world, const Plan& plan, double seconds) {
  constexpr std::size_t kFew = 100'000;
  constexpr double kWorthwhile = 0.6;  // fraction of the time
  if (scene.settings.samples || scene.settings.sample_spacing ||
      std::ranges::none_of(plan.groups, [](const BodyPlan& group) { return group.samples > 2 * kFew; }))
    return {};
  Scene trial = scene;
  trial.settings.samples = kFew;
  const double less = expected_seconds(trial, make_plan(trial, world));
  if (less > kWorthwhile * seconds) return {};
  return fmt::format("; about {:.0f} s, for less detail, with --set settings.samples={}", std::ceil(less),
                     kFew);
}

Paragraphs paragraphs_of(const Scene& scene, const World& world, const Plan& plan) {
  Paragraphs text;
  add_row(text, "scene",
          fmt::format("{}: {}, {}", scene.file, counted(scene.shapes.size(), "shape"),
                      counted(plan.triangles, "triangle")));
  if (!scene.translation.empty()) add_row(text, "asset", scene.translation);
  add_row(text, "image", picture_text(scene));
  add_row(text, "lights", lights_text(scene.lights));
  for (std::size_t g = 0; g < std::min(plan.groups.size(), kMostShown); ++g)
    add_group(text, scene, world, plan.groups[g]);
  if (plan.groups.size() > kMostShown)
    add_row(text, "", fmt::format("and {} more bodies", grouped(plan.groups.size() - kMostShown)));
  if (plan.groups.empty())
    add_row(text, "translucent", "none; no samples are needed" + marble_text(scene, world));
  for (std::size_t i = 0; i < plan.stages.size(); ++i) add_row(text, i == 0 ? "stages" : "", plan.stages[i]);
  add_row(text, "memory", "about " + short_bytes(plan.bytes) + " at the peak");
  if (const double seconds = expected_seconds(scene, plan); seconds > kLong)
    add_row(text, "time",
            fmt::format("about {} s of CPU{}{}", grouped(std::uint64_t(seconds)),
                        scene.settings.until_error ? ", plus the time to reach settings.until_error" : "",
                        fewer_samples_text(scene, world, plan, seconds)));
  return text;
}

Json model_json(const BodyModel& model) {
  Json json{
      {"profile", name_of(model.profile.kind)}, {"is_chosen", model.is_chosen}, {"reason", model.reason}};
  if (std::isfinite(model.profile.thickness)) json["thickness_mm"] = model.profile.thickness;
  if (model.expected_error) json["expected_error"] = *model.expected_error;
  if (model.expected_error_of_diffusion)
    json["expected_error_of_volume_diffusion"] = *model.expected_error_of_diffusion;
  return json;
}

/// asks_air: includes transport across the air, slow to compute
Json group_json(const Scene& scene, const World& world, const BodyPlan& group, bool asks_air) {
  Json shapes = Json::array();
  for (const std::uint32_t mesh : group.meshes) shapes.push_back(scene.shapes[mesh].name);
  return {{"name", group.name},
          {"shapes", shapes},
          {"medium", scene.media[group.medium].name},
          {"area_mm2", group.area},
          {"smallest_mean_free_path_mm", group.smallest_mean_free_path},
          {"model", model_json(group.model)},
          {"across_air", asks_air ? share_across_air(scene, world, group) : 0},
          {"spacing_mm", group.spacing},
          {"samples", group.samples},
          {"reason", group.reason}};
}

Json plan_json(const Scene& scene, const World& world, const Plan& plan) {
  Json lights = Json::array(), groups = Json::array();
  for (std::size_t l = 0; l < scene.lights.size(); ++l)
    if (l == 0 || !share_rays(scene.lights[l - 1], scene.lights[l]))
      lights.push_back({{"name", scene.lights[l].name}, {"type", name_of(scene.lights[l].source)}});
  for (const BodyPlan& group : plan.groups)
    groups.push_back(group_json(scene, world, group, plan.groups.size() <= kMostShown));
  Json json{{"scene", scene.file},
            {"method", name_of(scene.settings.method)},
            {"evaluator", name_of(scene.settings.evaluator)},
            {"resolution", scene.film.resolution},
            {"samples_per_pixel", scene.film.samples_per_pixel},
            {"filter", name_of(scene.film.filter)},
            {"shapes", scene.shapes.size()},
            {"triangles", plan.triangles},
            {"lights", lights},
            {"groups", groups},
            {"stages", plan.stages},
            {"memory_bytes", plan.bytes},
            {"cpu_seconds", expected_seconds(scene, plan)}};
  if (!scene.translation.empty()) json["asset"] = scene.translation;
  if (scene.film.crop) json["crop"] = *scene.film.crop;
  return json;
}

/// Text of three channels: "83 79 -"; "-" for an empty channel.
template <class Figure>
std::string three(const PlateModel& plate, const Figure& figure) {
  std::string text;
  for (const auto& channel : plate.channels)
    text += (text.empty() ? "" : " ") + (channel ? fmt::format("{:.3g}", figure(*channel)) : "-");
  return text;
}

Json plate_json(const PlateModel& plate) {
  const auto shares = [](const SlabLight& light) {
    return Json{{"back", light.back}, {"through", light.through}};
  };
  Json channels = Json::array();
  for (const auto& channel : plate.channels)
    channels.push_back(channel ? Json{{"mean_free_paths", channel->optical_thickness},
                                      {"profile", shares(channel->profile)},
                                      {"random_walks", shares(channel->walks)}}
                               : Json());
  return {{"body", plate.body}, {"thickness_mm", plate.thickness}, {"channels", channels}};
}

void print_plate(const PlateModel& plate) {
  using Channel = PlateChannel;
  print_row(
      "model error",
      fmt::format("{} has the thickness of a plate of {:.3g} mm: {} mean free paths (R G B)", plate.body,
                  plate.thickness, three(plate, [](const Channel& c) { return c.optical_thickness; })));
  print_row("", fmt::format("of transmitted diffuse light, `{}` reflects {} % and transmits {} %;",
                            name_of(plate.kind),
                            three(plate, [](const Channel& c) { return 100 * c.profile.back; }),
                            three(plate, [](const Channel& c) { return 100 * c.profile.through; })));
  print_row("", fmt::format("random walks (reference): {} % and {} %",
                            three(plate, [](const Channel& c) { return 100 * c.walks.back; }),
                            three(plate, [](const Channel& c) { return 100 * c.walks.through; })));
}

void warn_of_nothing_seen(const Log& log) {
  print_warning(log,
                "no translucent object is visible, so --target-error has no effect; settings.light_samples "
                "controls noise on opaque surfaces, --spp antialiasing");
}

}  // namespace

void print_row(const std::string& label, const std::string& text) {
  write_line(stdout, fmt::format("{:<12}{}", label, text));
}

void print_plates(const Log& log, const std::vector<PlateModel>& plates) {
  if (log.quiet) return;
  for (const PlateModel& plate : plates)
    if (log.format == LogFormat::json)
      print_event(log, "plate", plate_json(plate));
    else
      print_plate(plate);
}

void warn_of_unused_media(const Log& log, std::span<const std::string> overrides, const Scene& scene) {
  std::vector<std::string_view> used;
  for (const Shape& shape : scene.shapes) {
    if (!shape.medium) continue;
    used.push_back(scene.media[*shape.medium].name);
    for (const MediumLayer& layer : scene.media[*shape.medium].layers) used.push_back(layer.medium);
  }
  for (std::size_t m = 0; m < scene.media.size(); ++m) {
    const std::string prefix = "media." + scene.media[m].name + ".";
    const bool is_set =
        std::ranges::any_of(overrides, [&](const std::string& text) { return text.starts_with(prefix); });
    if (is_set && std::ranges::find(used, scene.media[m].name) == used.end())
      print_warning(log, fmt::format("no shape uses the medium '{0}' of --set {1}...{2}; assign it with "
                                     "--set shapes.NAME.medium={0}",
                                     scene.media[m].name, prefix, did_you_mean(scene.media[m].name, used)));
  }
}

void print_plan(const Log& log, const Scene& scene, const World& world, const Plan& plan,
                std::vector<std::string>* last) {
  if (!log.quiet && log.format == LogFormat::json) print_event(log, "plan", plan_json(scene, world, plan));
  const bool is_text = log.format == LogFormat::text;
  const auto is_known = [&](const std::string& text) {
    return is_text && last != nullptr && std::ranges::find(*last, text) != last->end();
  };
  Paragraphs said = is_text ? paragraphs_of(scene, world, plan) : Paragraphs{};
  for (const std::string& paragraph : said)
    if (!log.quiet && !is_known(paragraph)) write_line(stdout, paragraph);
  for (const std::string& warning : plan.warnings)
    if (!is_known(warning)) print_warning(log, warning);
  said.insert(said.end(), plan.warnings.begin(), plan.warnings.end());
  if (last != nullptr) *last = std::move(said);
}

void print_decisions(const Log& log, const std::vector<std::string>& decisions, const std::string& warning) {
  if (!log.quiet && log.format == LogFormat::json) print_event(log, "reuse", {{"decisions", decisions}});
  for (std::size_t i = 0; i < decisions.size() && !log.quiet && log.format == LogFormat::text; ++i)
    print_row(i == 0 ? "reuse" : "", decisions[i]);
  if (!warning.empty()) print_warning(log, warning);
}

void print_trial(const Log& log, double seconds) {
  if (!log.quiet && log.format == LogFormat::text && seconds > kLong)
    print_row("time",
              fmt::format("about {} s of CPU for the first trial, and at least as much for each further one",
                          grouped(std::uint64_t(seconds))));
}

void print_target(const Log& log, double target, const TargetError& chosen, const Settings& settings) {
  if (!log.quiet)
    print_event(log, "target",
                {{"target_error", target},
                 {"predicted_error", chosen.predicted},
                 {"reached", chosen.reached},
                 {"sees_translucent", chosen.sees_translucent},
                 {"samples", chosen.samples},
                 {"tolerance", settings.tolerance},
                 {"light_samples", settings.light_samples},
                 {"evaluator", name_of(settings.evaluator)}});
  if (!chosen.sees_translucent) return warn_of_nothing_seen(log);
  if (!log.quiet && log.format == LogFormat::text)
    print_row("target", fmt::format("{:.3g} %: {}, predicted error {}, tolerance {}", 100 * target,
                                    counted(chosen.samples, "sample"), short_percent(chosen.predicted),
                                    short_percent(settings.tolerance)));
  if (!chosen.reached)
    print_warning(
        log, fmt::format("cannot reach an error of {:.3g} % with {}; the predicted error is {}", 100 * target,
                         chosen.is_short_of_rays
                             ? grouped(std::uint64_t(kMostShadowRays)) + " shadow rays per light"
                             : fmt::format("settings.max_samples of {}", settings.max_samples),
                         short_percent(chosen.predicted)));
}

void print_repeat_command(const Log& log, const std::string& command) {
  if (log.quiet) return;
  print_event(log, "again_by", {{"command", command}});
  if (log.format == LogFormat::text) print_row("repeat with", command);
}

void print_volume_target(const Log& log, double target, const TargetError& chosen, const Settings& settings) {
  if (!log.quiet)
    print_event(log, "target",
                {{"target_error", target},
                 {"predicted_error", chosen.predicted},
                 {"model_error", chosen.model ? Json(*chosen.model) : Json()},
                 {"reached", chosen.reached},
                 {"sees_translucent", chosen.sees_translucent},
                 {"samples", chosen.samples},
                 {"cell_size", settings.cell_size},
                 {"light_samples", settings.light_samples}});
  if (!chosen.sees_translucent) return warn_of_nothing_seen(log);
  if (!log.quiet && log.format == LogFormat::text)
    print_row("target", fmt::format("{:.3g} %: {}, cells of {:.3g} mean free paths, predicted error {} {}",
                                    100 * target, counted(chosen.samples, "sample"), settings.cell_size,
                                    short_percent(chosen.predicted),
                                    chosen.model ? "against random walks" : "without that of the model"));
  if (!chosen.model)
    return print_warning(log,
                         "no error is promised: that of the model is unknown for bodies by hierarchical, and "
                         "for those that light "
                         "crosses almost without scattering");
  if (!chosen.reached)
    print_warning(log, fmt::format("cannot promise an error below {} against --method volume, including a "
                                   "model error of {}; opaline targets this error instead of {:.3g} %",
                                   short_percent(std::max(chosen.promised, chosen.predicted)),
                                   short_percent(*chosen.model), 100 * target));
}

void print_budget(const Log& log, double budget, double before, const TimeBudget& chosen,
                  const Settings& settings) {
  const double planned = before + chosen.planned;
  const bool has_cells = settings.method != Method::hierarchical;
  if (!log.quiet) {
    Json members{{"time_budget", budget},
                 {"planned", planned},
                 {"fits", chosen.fits},
                 {"at_most", chosen.at_most},
                 {"sees_translucent", chosen.sees_translucent},
                 {"samples", chosen.samples}};
    if (has_cells) {
      members["cell_size"] = settings.cell_size;
    } else {
      members["tolerance"] = settings.tolerance;
      members["evaluator"] = name_of(settings.evaluator);
    }
    if (chosen.predicted) members["predicted_error"] = *chosen.predicted;
    print_event(log, "budget", members);
  }
  if (!chosen.sees_translucent)
    return print_warning(log, "no translucent object is visible, so --time-budget has no effect");
  std::string error = chosen.predicted ? ", predicted error " + short_percent(*chosen.predicted) : "";
  if (has_cells && chosen.predicted) error += " against random walks";
  const std::string detail = has_cells ? fmt::format("cells of {:.3g} mean free paths", settings.cell_size)
                                       : "tolerance " + short_percent(settings.tolerance);
  const char* limit = !chosen.at_most ? ""
                      : has_cells     ? "; smaller cells would reduce the error little"
                                      : "; settings.max_samples limits the samples";
  if (!log.quiet && log.format == LogFormat::text)
    print_row("budget", fmt::format("{:.4g} s: {}, {}{}; planned {:.3g} s{}", budget,
                                    counted(chosen.samples, "sample"), detail, error, planned, limit));
  if (!chosen.fits)
    print_warning(
        log,
        fmt::format(
            "a budget of {:.4g} s of CPU is too small: opaline renders the cheapest image of this scene, in "
            "about {:.2g} s; fewer pixels, --spp or settings.light_samples reduce the cost",
            budget, planned));
}

void print_outputs(const Log& log, const char* event, const std::vector<std::string>& outputs) {
  if (log.quiet) return;
  if (log.format == LogFormat::json) print_event(log, event, {{"outputs", outputs}});
  for (std::size_t i = 0; i < outputs.size() && log.format == LogFormat::text; ++i)
    print_row(event, outputs[i]);
}

}  // namespace opaline
