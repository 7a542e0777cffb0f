// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/metadata.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "cli/report.h"
#include "input/schema.h"
#include "plan/expected_error.h"
#include "scene/names.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

Json settings_in_use(const Scene& scene, const World& world, std::span<const Body> translucent) {
  Json json = Json::parse(settings_json(scene));
  for (const char* asked : {"samples", "sample_spacing"})
    json.erase(asked);  // the bodies contain the resulting values
  for (const Body& group : translucent) {
    const BodyModel& model = group.plan.model;
    json["groups"].push_back({{"name", group.plan.name},
                              {"samples", group.surface.samples.size()},
                              {"spacing_mm", group.surface.spacing() * world.unit},
                              {"profile", name_of(model.profile.kind)}});
    if (const std::optional<double> error = expected_error(model, group.plan.method))
      json["groups"].back()["expected_model_error"] = *error;
  }
  return json;
}

/// Quotes names beginning like an option.
std::string quoted_path(const std::string& path) {
  return shell_quoted(path.starts_with('-') ? "./" + path : path);
}

std::string command_line(const std::string& program, const std::string& scene,
                         const std::vector<std::string>& overrides) {
  std::string line = shell_quoted(program) + " render " + quoted_path(scene);
  for (const std::string& text : overrides) line += " --set " + shell_quoted(text);
  return line;
}

}  // namespace

std::string shell_quoted(const std::string& argument) {
  const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=,:+-%@";
  if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos) return argument;
  std::string quoted = "'";
  for (const char c : argument) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

namespace {

/// Option selecting the layers; empty for the default ones.
std::string layers_text(const RenderArguments& arguments) {
  const LayerChoice& layers = arguments.layers;
  if (!layers.all && layers.names == RenderArguments{}.layers.names) return {};
  std::vector<std::string> words = layers.names;
  if (layers.all) words.insert(words.begin(), "all");
  if (words.empty()) words.push_back("none");
  return fmt::format(" --layers {}", fmt::join(words, ","));
}

}  // namespace

std::string command_of(const RenderArguments& arguments) {
  std::string command = command_line("opaline", arguments.scene, arguments.overrides);
  if (arguments.target_error)
    command += *arguments.target_error < 1 ? fmt::format(" --target-error {}", *arguments.target_error)
                                           : " --target-error 100%";
  return command + layers_text(arguments);
}

std::string command_again(const RenderArguments& arguments) {
  std::string command = command_line(arguments.program, arguments.scene, arguments.overrides);
  for (const std::string& output : arguments.outputs) command += " -o " + quoted_path(output);
  return command + layers_text(arguments);
}

Metadata make_metadata(const RenderArguments& arguments, const std::string& hash, const Scene& scene,
                       const World& world, std::span<const Body> translucent, std::optional<int> frame) {
  const std::string name = fs::path(arguments.scene).filename().string();
  Metadata metadata{{"opaline:version", OPALINE_VERSION}, {"opaline:scene", name}};
  if (!hash.empty()) metadata.emplace_back("opaline:scene_hash", hash);
  metadata.emplace_back("opaline:seed", std::to_string(scene.settings.seed));
  metadata.emplace_back("opaline:settings", compact(settings_in_use(scene, world, translucent)));
  RenderArguments without_folder = arguments;
  without_folder.scene = name;
  metadata.emplace_back("opaline:command", command_of(without_folder));
  if (frame) metadata.emplace_back("opaline:frame", std::to_string(*frame));
  return metadata;
}

Metadata frame_metadata(const RenderArguments& arguments, const std::string& hash, int frame) {
  const std::string name = fs::path(arguments.scene).filename().string();
  return {{"opaline:version", OPALINE_VERSION},
          {"opaline:scene_hash", hash},
          {"opaline:command", command_line("opaline", name, arguments.overrides) + layers_text(arguments)},
          {"opaline:frame", std::to_string(frame)}};
}

std::pair<std::string, std::string> timings_metadata(const std::vector<StageCost>& costs) {
  Json stages = Json::array();
  for (const StageCost& cost : costs) stages.push_back(stage_json(cost));
  return {"opaline:timings", compact(stages)};
}

}  // namespace opaline
