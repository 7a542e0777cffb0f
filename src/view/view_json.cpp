// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_json.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "bodies/plan_texts.h"
#include "core/log.h"
#include "core/units.h"
#include "input/load_scene.h"
#include "input/presets.h"
#include "input/schema.h"
#include "plan/choose_models.h"
#include "plan/expected_error.h"
#include "scene/names.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

/// Names of the types in the page, in the order of ValueType; a file is a text.
constexpr std::array<const char*, 13> kTypeNames{
    "number", "whole_number", "length", "point", "triple", "number_or_triple", "color", "flag",
    "choice", "text",         "text",   "list",  "object"};

/// Ends of a slider: those of the range, or a thousandth inside if the range excludes them.
Json slider_json(const Range& range) {
  constexpr double kWidest = 1e6;  // maximum range of a slider
  const double width = range.high - range.low, inside = width < kWidest ? 1e-3 * width : 0;
  return {range.low + (range.without_low ? inside : 0), range.high - (range.without_high ? inside : 0)};
}

Json row_json(const KeyInfo& info) {
  Json choices = Json::array();
  for (const std::string_view choice : info.choices) choices.push_back(choice);
  return {{"section", info.section},
          {"key", info.key},
          {"type", kTypeNames[std::size_t(info.type)]},
          {"unit", info.unit},
          {"range", {info.range.low, info.range.high}},
          {"slider", slider_json(info.range)},
          {"default", info.default_value},
          {"meaning", info.meaning},
          {"choices", choices}};
}

Json preset_json(std::string_view name, bool is_measured) {
  const Medium medium = parse_medium(fmt::format("{{\"preset\": \"{}\"}}", name), "preset");
  const auto& physical = std::get<PhysicalMedium>(medium.coefficients);
  const auto triple = [](const Rgb& c) { return Json{c.x, c.y, c.z}; };
  Json chosen{{"preset", name}};  // the medium that the page adds
  if (is_measured) chosen["specular_roughness"] = kMeasuredRoughness;
  return {{"name", name},
          {"sigma_a", triple(physical.sigma_a)},
          {"sigma_s_prime", triple(physical.sigma_s_prime)},
          {"specular_ior", medium.eta},
          {"specular_roughness", medium.specular_roughness},
          {"is_measured", is_measured},
          {"chosen", std::move(chosen)}};
}

Json group_json(const Scene& scene, const BodyPlan& group) {
  std::string text = fmt::format("{} of {}: {:.4g} mm², {}", group.name, scene.media[group.medium].name,
                                 group.area, mean_free_path_text(scene, group));
  if (method_of(scene.settings.method).needs_samples()) text += "; " + samples_text(group);
  text += "; profile " + model_text(group.model);
  const std::string error = model_error_text(group.model, group.method, !leaves_out_reentry(scene, group));
  if (!error.empty()) text += "; " + error;
  return {{"name", group.name},
          {"medium", scene.media[group.medium].name},
          {"thickness", group.thickness},
          {"mean_free_path", group.smallest_mean_free_path},
          {"text", text}};
}

std::string progress_text(const char* kind, const Monitor& monitor) {
  const char* stage = monitor.stage;
  return compact({{"is", kind},
                  {"stage", stage != nullptr ? stage : ""},
                  {"done", monitor.done.load()},
                  {"total", monitor.total.load()}});
}

}  // namespace

std::string schema_text() {
  Json rows = Json::array(), presets = Json::array();
  for (const KeyInfo& info : schema()) rows.push_back(row_json(info));
  for (const std::string_view name : preset_names())
    presets.push_back(preset_json(name, presets.size() < measured_presets().size()));
  return compact({{"is", "schema"}, {"rows", rows}, {"presets", presets}, {"version", OPALINE_VERSION}});
}

std::string scene_text(const SceneEdits& edits, const std::string& command,
                       const std::vector<std::string>& environments) {
  Json look;
  if (const std::optional<LookFrom>& own = edits.own_camera())
    look = {{"position", Json::parse(own->position)}, {"look_at", Json::parse(own->look_at)}};
  return compact({{"is", "scene"},
                  {"revision", edits.revision()},
                  {"file", std::filesystem::path(edits.file()).filename().string()},
                  {"path", std::filesystem::absolute(edits.file()).string()},
                  {"scene", Json::parse(edits.json())},
                  {"look", look},
                  {"edits", edits.edits()},
                  {"undo", edits.can_undo()},
                  {"redo", edits.can_redo()},
                  {"floor", edits.has_floor()},
                  {"command", command},
                  {"environments", environments},
                  {"frames", edits.frames()},
                  {"frame", edits.frame().value_or(1)}});
}

std::string plan_text(std::uint32_t revision, const Scene& scene, const Plan& plan,
                      std::span<const Bounds> boxes) {
  Json groups = Json::array(), bounds = Json::array();
  const auto point = [&](const Vec3d& mm) {
    const Vec3d p = mm / scene.mm_per_unit;
    return Json{p.x, p.y, p.z};
  };
  for (const Bounds& box : boxes) bounds.push_back({point(box.low), point(box.high)});
  for (const BodyPlan& group : plan.groups) groups.push_back(group_json(scene, group));
  return compact({{"is", "plan"},
                  {"revision", revision},
                  {"groups", groups},
                  {"boxes", bounds},
                  {"stages", plan.stages},
                  {"warnings", plan.warnings},
                  {"model_error", expected_model_error(plan).value_or(0)},
                  {"model_is_unknown", !bodies_of_unknown_error(plan).empty()},
                  {"memory", "about " + short_bytes(plan.bytes) + " at the peak"}});
}

std::string report_text(const ViewReport& report) {
  Json costs = Json::array();
  for (const StageCost& cost : report.costs)
    costs.push_back({{"stage", cost.stage}, {"wall", cost.wall_seconds}, {"cpu", cost.cpu_seconds}});
  return compact({{"is", "report"},
                  {"revision", report.revision},
                  {"error", report.error},
                  {"costs", costs},
                  {"reused", report.reused},
                  {"warnings", report.warnings}});
}

std::string behind_text(const WorkBehind& wanted) {
  return compact({{"is", "behind"}, {"trade", wanted.trade}, {"reference", wanted.reference}});
}

std::string trade_text(const TradeState& trade) {
  Json points = Json::array();
  for (const TradePoint& point : trade.points) {
    Json values = Json::object();
    if (point.sample_spacing) values["settings.sample_spacing"] = *point.sample_spacing / trade.mm_per_unit;
    if (point.samples) values["settings.samples"] = *point.samples;
    if (point.tolerance > 0) values["settings.tolerance"] = point.tolerance;
    points.push_back({{"method", name_of(point.method)},
                      {"samples", point.all_samples},
                      {"values", values},
                      {"seconds", point.seconds},
                      {"error", point.error}});
  }
  const Json now = trade.now ? Json(*trade.now) : Json();
  return compact({{"is", "trade"},
                  {"revision", trade.revision},
                  {"points", points},
                  {"now", now},
                  {"whole", trade.is_whole}});
}

std::string reference_text(const ReferenceState& state) {
  return compact({{"is", "reference"},
                  {"revision", state.revision},
                  {"method", name_of(state.method)},
                  {"samples", state.samples},
                  {"noise", std::isfinite(state.noise) ? state.noise : 0},
                  {"difference", state.difference}});
}

std::string work_text(const Monitor& monitor) {
  return progress_text("work", monitor);
}

std::string file_text(const Monitor& monitor, bool is_rendered) {
  return is_rendered ? progress_text("file", monitor) : compact({{"is", "file"}, {"stage", ""}});
}

std::string failed_text(std::uint32_t revision, const std::string& why) {
  return compact({{"is", "failed"}, {"revision", revision}, {"text", why}});
}

std::string told_text(bool good, const std::string& text) {
  return compact({{"is", "told"}, {"good", good}, {"text", text}});
}

std::string picked_text(std::optional<std::size_t> shape) {
  return compact({{"is", "picked"}, {"shape", shape ? Json(*shape) : Json()}});
}

std::string told_choice(double target, const TargetError& chosen) {
  if (!chosen.sees_translucent)
    return told_text(false, "no translucent object is visible, so a target error has no effect");
  return told_text(chosen.reached, fmt::format("{:.3g} %: {} samples, predicted error {}{}", 100 * target,
                                               chosen.samples, short_percent(chosen.predicted),
                                               chosen.reached ? "" : ", the least possible"));
}

}  // namespace opaline
