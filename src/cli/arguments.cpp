// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>
#include <system_error>

#include "assets/import_asset.h"
#include "cli/asset_options.h"
#include "cli/command_options.h"
#include "cli/frames.h"
#include "cli/help_texts.h"
#include "cli/metadata.h"
#include "cli/option_values.h"
#include "cli/quality.h"
#include "core/lower_case.h"
#include "input/overrides.h"
#include "input/schema.h"
#include "opaline/error.h"
#include "scene/unread_format.h"
#include "values/json_tree.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

std::vector<std::string> overrides_of(const Options& options, const std::string& scene) {
  std::vector<std::string> overrides;
  if (!options.environment.empty()) overrides = environment_overrides(options.environment);
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) overrides.push_back(fmt::format("{}={}", key, value));
  };
  if (options.spp) add("film.samples_per_pixel", std::to_string(*options.spp));
  if (!options.resolution.empty()) add("film.resolution", resolution_json(options.resolution));
  if (!options.crop.empty()) add("film.crop", crop_json(options.crop));
  if (options.exposure) add("film.exposure", fmt::format("{}", *options.exposure));
  add("film.view", options.view);
  if (options.denoise) add("film.denoise", "true");
  if (options.entry_samples) add("settings.entry_samples", std::to_string(*options.entry_samples));
  if (!options.until_error.empty())
    add("settings.until_error", fmt::format("{}", *share_of(options.until_error)));
  add("settings.method", options.method);
  add("settings.evaluator", options.evaluator);
  if (options.seed) add("settings.seed", std::to_string(*options.seed));
  for (const std::string& medium : options.media)
    for (std::string& text : medium_overrides(scene, medium)) overrides.push_back(std::move(text));
  overrides.insert(overrides.end(), options.sets.begin(), options.sets.end());
  return overrides;
}

Error usage_error(const std::string& message, const std::string& expected = {}, const std::string& got = {}) {
  return Error(ErrorKind::bad_input, {}, 0, 0, message, expected, got);
}

Error unknown_format(const std::string& path) {
  return usage_error("unknown output format", "a name that ends in .exr or .png, or in .mp4 for frames",
                     "'" + path + "'");
}

/// Canonical path of a file, existing or not.
std::string whole_path(const std::string& path) {
  std::error_code unknown;
  const std::filesystem::path whole =
      std::filesystem::weakly_canonical(std::filesystem::absolute(path), unknown);
  return unknown ? path : whole.string();
}

void check_movie(const RenderArguments& render, const std::string& path, bool has_place) {
  if (render.frames.empty())
    throw usage_error("a movie requires several frames", "--frames FIRST-LAST", "'" + path + "'");
  if (has_place) throw usage_error("a movie has all frames", "a name without ##", "'" + path + "'");
  if (std::ranges::count(render.outputs, OutputFormat::mp4, output_format) > 1)
    throw usage_error("more than one movie", "one output that ends in .mp4");
}

void check_part_output(const RenderArguments& render) {
  const auto parts = std::ranges::count(render.outputs, OutputFormat::part, output_format);
  if (!render.part && parts > 0)
    throw usage_error("a .part file holds one part of an image",
                      "--part K/N, or an output that ends in .exr");
  if (!render.part) return;
  if (render.outputs.size() != 1 || parts != 1)
    throw usage_error("--part writes a part of the image", "one output that ends in .part");
  if (render.frames.size() > 1) throw usage_error("--part renders a part of one image", "--frames N");
  if (!render.resume.empty() || !render.samples_ply.empty() || render.target_error || render.time_budget ||
      render.verify)
    throw usage_error(
        "--part cannot be combined with --resume, --samples-ply, --target-error, --time-budget or --verify");
}

void check_outputs(const RenderArguments& render) {
  for (const std::string& path : render.outputs)
    if (output_format(path) == OutputFormat::unknown) throw unknown_format(path);
  check_part_output(render);
  std::vector<std::string> files = render.outputs;
  for (const std::string& more : {render.samples_ply, render.resume})
    if (!more.empty()) files.push_back(more);
  std::set<std::string> seen;
  for (const std::string& path : files) {
    if (!seen.insert(whole_path(path)).second)
      throw usage_error("two outputs have the same name '" + path + "'");
    const bool has_place = path.find("##") != std::string::npos;
    if (output_format(path) == OutputFormat::mp4) {
      check_movie(render, path, has_place);
      continue;
    }
    if (render.frames.size() > 1 && !has_place)
      throw usage_error(
          "all frames have the same output name '" + path + "'" +
              (path.find('#') != std::string::npos ? ": a single # is not a frame number placeholder" : ""),
          "## for the frame number, as in out.####.exr");
    if (render.frames.empty() && has_place)
      throw usage_error("'" + path + "' has a frame number placeholder, but no frames are requested",
                        "--frames FIRST-LAST, or a name without ##");
  }
}

/// error Error{bad_input}: layers without an output to store them
void check_layers_have_a_file(const RenderArguments& render, const std::string& asked) {
  const bool has_exr = std::ranges::any_of(
      render.outputs, [](const std::string& path) { return output_format(path) == OutputFormat::exr; });
  if (!asked.empty() && asked != "none" && !has_exr && !render.part)
    throw usage_error("--layers requires an EXR output", "-o FILE.exr", "'" + render.outputs.front() + "'");
}

CompareArguments checked(CompareArguments compare, const Options& options) {
  if (compare.reference.empty() == compare.halves.empty())
    throw usage_error("compare requires either a reference B or --halves D1 D2");
  const OutputFormat format = output_format(compare.error_picture);
  if (!compare.error_picture.empty() && format != OutputFormat::exr && format != OutputFormat::png)
    throw unknown_format(compare.error_picture);
  if (!std::isfinite(compare.exposure.value_or(0)))
    throw usage_error("--exposure", "a finite number", fmt::format("{}", *compare.exposure));
  if (!options.fail_above.empty()) compare.fail_above = share_of(options.fail_above);
  return compare;
}

ImportArguments checked(ImportArguments import) {
  if (const std::string unread = unread_format(import.asset); !unread.empty())
    throw bad_file(import.asset, unread);
  if (!is_asset_name(import.asset))
    throw bad_file(import.asset, "is not a supported asset format",
                   "a name that ends in .glb, .gltf, .obj, .ply, .stl or .off");
  if (!import.scene.ends_with(".json"))
    throw usage_error("the output of import must be a scene file", "a name that ends in .json",
                      "'" + import.scene + "'");
  return import;
}

constexpr double kReferenceError = .02, kQuickReferenceError = .03;

BenchArguments checked(BenchArguments bench, const Options& options) {
  if (!bench.halves.empty() && bench.scenes.size() > 1)
    throw usage_error("--halves requires a single scene", "a single scene",
                      std::to_string(bench.scenes.size()));
  if (!bench.halves.empty() && bench.profiles)
    throw usage_error(
        "--halves cannot be combined with --profiles, because each profile has its own reference");
  if (!bench.halves.empty() && !(options.reference_error.empty() && bench.reference_dir.empty()))
    throw usage_error(
        "--halves cannot be combined with --reference-error or --reference-dir, because no reference is "
        "rendered");
  if (bench.csv.empty() && bench.report.empty() && bench.against.empty())
    throw usage_error("no output is requested", "-o FOLDER, --csv FILE or --against FILE");
  bench.reference_error = options.reference_error.empty()
                              ? (bench.quick ? kQuickReferenceError : kReferenceError)
                              : *share_of(options.reference_error);
  for (const std::string& text : options.rungs) {
    const std::size_t equals = text.find('=');
    bench.rungs.push_back({"hierarchical", "", text.substr(0, equals), text.substr(equals + 1)});
  }
  bench.overrides = overrides_of(options, {});
  return bench;
}

/// CLI11 reports help and version as exceptions, too.
ShowText shown_text(CLI::App& app, const CLI::ParseError& request) {
  std::ostringstream out, error;
  app.exit(request, out, error);
  std::string text = out.str();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return {text};
}

/// The called command, or its subcommand: "cache ls".
const CLI::App& called(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? app : called(*chosen.front());
}

/// "cache ls"; empty for the program itself.
std::string words_to(const CLI::App& command) {
  std::string words = command.get_parent() != nullptr ? command.get_name() : "";
  for (const CLI::App* at = command.get_parent(); at != nullptr && at->get_parent() != nullptr;
       at = at->get_parent())
    words = at->get_name() + ' ' + words;
  return words;
}

std::string hint(const CLI::App& command) {
  const std::string words = words_to(command);
  return fmt::format("; see opaline {}{}--help", words, words.empty() ? "" : " ");
}

std::vector<std::string_view> commands_of(const CLI::App& app) {
  std::vector<std::string_view> names;
  for (const CLI::App* command :
       app.get_subcommands([](const CLI::App* c) { return !c->get_group().empty(); }))
    names.push_back(command->get_name());
  return names;
}

Error no_command(const CLI::App& parent) {
  return usage_error("no command given: " + join(commands_of(parent)) + hint(parent));
}

Error unknown_command(const CLI::App& parent, const std::string& name) {
  const std::vector<std::string_view> names = commands_of(parent);
  const std::string near = did_you_mean(name, names);
  return usage_error("unknown command '" + printable(name) + "'" + near,
                     near.empty() ? "one of " + join(names) : "");
}

/// Similar options or keys for setting a scene value on this command: "--spp N", or --set.
std::vector<std::string> ways_to_set(const CLI::App& command, std::string key) {
  std::vector<std::string> ways;
  if (command.get_option_no_throw("--set") == nullptr) return ways;
  key.erase(0, key.find_first_not_of('-'));
  std::ranges::replace(key, '-', '_');
  for (const std::string& path : similar_key_paths(key)) {
    const std::string option(option_of_key(path));
    const CLI::Option* own = option.empty() ? nullptr : command.get_option_no_throw(option);
    const ValueType type = key_at(path).type;
    const bool is_number = type == ValueType::number || type == ValueType::whole_number;
    ways.push_back(own != nullptr ? option + ' ' + own->get_type_name()
                                  : "--set " + path + (is_number ? "=N" : "=VALUE"));
  }
  return ways;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& word : option->get_lnames()) names.push_back("--" + word);
    for (const std::string& letter : option->get_snames()) names.push_back("-" + letter);
  }
  return names;
}

/// Names of the commands with an option, below one: "render", "cache ls".
std::vector<std::string> commands_with(const CLI::App& parent, const std::string& option) {
  std::vector<std::string> found;
  for (const CLI::App* command :
       parent.get_subcommands([](const CLI::App* c) { return !c->get_group().empty(); })) {
    const std::vector<std::string> names = option_names(*command);
    if (std::ranges::find(names, option) != names.end()) found.push_back(command->get_name());
    for (const std::string& inner : commands_with(*command, option))
      found.push_back(command->get_name() + ' ' + inner);
  }
  return found;
}

std::string similar_option(const CLI::App& command, const std::string& name) {
  const std::vector<std::string> names = option_names(command);
  const std::vector<std::string_view> views(names.begin(), names.end());
  return did_you_mean(name, views);
}

/// The first command below one with a similar option, with the suggestion: " (did you mean '--spp'?), an option of
/// opaline render".
std::string similar_elsewhere(const CLI::App& parent, const std::string& name) {
  for (const std::string_view word : commands_of(parent)) {
    const CLI::App& command = *parent.get_subcommand(std::string(word));
    if (const std::string near = similar_option(command, name); !near.empty())
      return near + ", an option of opaline " + words_to(command);
    if (std::string near = similar_elsewhere(command, name); !near.empty()) return near;
  }
  return {};
}

Error unknown_option(const CLI::App& app, const CLI::App& command, const std::string& text) {
  const std::string name = text.substr(0, text.find('='));
  const std::vector<std::string> names = option_names(command);
  // A prefix matches full names; an unknown letter matches names beginning with it.
  const bool is_letter = name.size() == 2;
  const std::string beginning = is_letter ? '-' + name : name;
  std::vector<std::string> meant = is_letter ? std::vector<std::string>{} : ways_to_set(command, name);
  if (const std::vector<std::string> others = commands_with(app, name); meant.empty() && !others.empty())
    return usage_error(fmt::format("unknown option '{}' (an option of opaline {}){}", printable(name),
                                   fmt::join(others, ", "), hint(command)));
  if (meant.empty())
    std::ranges::copy_if(names, std::back_inserter(meant),
                         [&](const std::string& word) { return word.starts_with(beginning); });
  std::string near = !meant.empty() ? fmt::format(" (did you mean '{}'?)", fmt::join(meant, "' or '"))
                     : is_letter    ? ""
                                    : similar_option(command, name);
  if (near.empty() && !is_letter) near = similar_elsewhere(app, name);
  return usage_error("unknown option '" + printable(name) + "'" + near + hint(command));
}

/// Reports an unknown option, possibly a misspelt required one, before a missing one; CLI11's order is the
/// reverse.
Error parse_error(const CLI::App& app, const CLI::ParseError& failure) {
  const CLI::App& command = called(app);
  const std::vector<std::string> extras = command.remaining();
  const bool is_unknown = dynamic_cast<const CLI::ExtrasError*>(&failure) != nullptr ||
                          dynamic_cast<const CLI::RequiredError*>(&failure) != nullptr;
  const std::string what = failure.what();
  if (const std::size_t end = what.find(": At Most 1 required but received"); end != std::string::npos)
    return usage_error(what.substr(0, end) + ": given more than once" + hint(command));
  const bool has_commands = !commands_of(command).empty();
  if (is_unknown && extras.empty() && has_commands) return no_command(command);
  if (!is_unknown || extras.empty()) return usage_error(what + hint(command));
  if (has_commands && !extras.front().starts_with('-')) return unknown_command(command, extras.front());
  const auto option = std::ranges::find_if(extras, [](const std::string& e) { return e.starts_with('-'); });
  if (option != extras.end()) return unknown_option(app, command, *option);
  return usage_error("unexpected argument '" + printable(extras.front()) + "'" + hint(command));
}

/// Arguments after the program's name; "help render" becomes "render --help".
std::vector<std::string> words_of(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty() || words.front() != "help") return words;
  std::erase(words, "help");
  const CLI::App* command = &app;
  for (const std::string& word : words) {
    const auto commands = command->get_subcommands([&](const CLI::App* c) { return c->get_name() == word; });
    if (commands.empty()) throw unknown_command(*command, word);
    command = commands.front();
  }
  words.push_back("--help");
  return words;
}

/// Targets of the options of each command.
struct Parsed {
  RenderArguments render;
  InfoArguments info;
  CompareArguments compare;
  MergeArguments merge;
  PrecomputeArguments precompute;
  BenchArguments bench;
  CacheArguments cache;
  ProfileArguments profile;
  ImportArguments import;
  ViewArguments view;
  Options options;
  std::string program, words;  ///< program as called, and the arguments after it, quoted for a shell
};

void add_commands(CLI::App& app, Parsed& parsed) {
  const auto command = [&](const char* name, const char* help) -> CLI::App& {
    return *app.add_subcommand(name, help);
  };
  Options& options = parsed.options;
  add_render_options(command("render", "render a scene to EXR and PNG files"), parsed.render, options);
  add_turntable_options(command("turntable", "render a turn around a scene or asset, as frames or a movie"),
                        parsed.render, options);
  add_merge_options(command("merge", "add the parts of an image (render --part)"), parsed.merge, options);
  add_view_options(command("view", "edit a scene in the browser, with a live preview"), parsed.view, options);
  add_precompute_options(command("precompute", "compute the stages of a scene and store them in a cache"),
                         parsed.precompute, options);
  CLI::App& info =
      command("info", "print the plan of a scene: stages, samples, memory, expected errors; renders nothing");
  add_common_options(info, parsed.info.scene, options);
  add_picture_options(info, options);
  add_import_options(
      command("import", "convert an asset (.glb, .gltf, .obj, .ply, .stl, .off) to a scene file for editing"),
      parsed.import, options);
  add_compare_options(command("compare", "compare an image with a reference"), parsed.compare, options);
  add_bench_options(command("bench", "measure cost and error of scenes at many settings"), parsed.bench,
                    options);
  add_profile_options(command("profile", "compare diffusion models with random walks, for one medium"),
                      parsed.profile, options);
  add_cache_commands(command("cache", "list, verify or prune a folder of stage results (--cache)"),
                     parsed.cache, options);
  command("schema", "print a JSON Schema of scene files, for editors");
  command("completion", "print a completion script for bash").group("");
}

MergeArguments checked(MergeArguments merge, const Parsed& parsed) {
  check_outputs(merge.render);
  merge.render.log = merge.log;
  merge.render.program = parsed.program;
  merge.render.command_line = shell_quoted(parsed.program) + parsed.words;
  return merge;
}

RenderArguments checked(RenderArguments render, const Options& options) {
  if (!options.layers.empty()) render.layers = *layers_of(options.layers);
  if (!options.part.empty()) render.part = *part_of(options.part);
  check_outputs(render);
  if (render.frames_per_second &&
      std::ranges::find(render.outputs, OutputFormat::mp4, output_format) == render.outputs.end())
    throw usage_error("--fps has no effect without a movie", "-o FILE.mp4");
  check_layers_have_a_file(render, options.layers);
  if (!options.target_error.empty()) render.target_error = share_of(options.target_error);
  render.time_budget = options.time_budget;
  render.gives_entry_samples = options.entry_samples.has_value();
  render.gives_until_error = !options.until_error.empty();
  check_quality(render);
  return render;
}

/// The overrides, with that of --size.
std::vector<std::string> sized_overrides(const Options& options, const std::string& scene) {
  std::vector<std::string> overrides = overrides_of(options, scene);
  if (!options.size) return overrides;
  if (scene.empty()) throw usage_error("--size needs a scene", "SCENE");
  if (std::ranges::any_of(options.sets,
                          [](const std::string& text) { return text.starts_with("mm_per_unit="); }))
    throw usage_error("--size sets mm_per_unit, which is given, too", "one of the two");
  overrides.push_back(size_override(scene, overrides, *options.size));
  return overrides;
}

Command command_of(const std::string& name, Parsed parsed) {
  const Options& options = parsed.options;
  const auto with_log = [&](auto arguments) {
    arguments.log.format = options.json || options.log == "json" ? LogFormat::json : LogFormat::text;
    return arguments;
  };
  const auto with_overrides = [&](auto arguments) {
    arguments.overrides = sized_overrides(options, arguments.scene);
    return with_log(std::move(arguments));
  };
  const auto with_frames = [&](auto arguments) {
    if (options.frames) arguments.frames = parse_frames(*options.frames);
    return with_overrides(std::move(arguments));
  };
  if (name == "compare") return checked(with_log(std::move(parsed.compare)), options);
  if (name == "import") {
    ImportArguments import = checked(std::move(parsed.import));
    import.overrides = sized_overrides(options, import.asset);
    return import;
  }
  if (name == "cache") return with_log(std::move(parsed.cache));
  parsed.profile.command_line = parsed.bench.command_line = parsed.words;
  if (name == "profile") return with_log(std::move(parsed.profile));
  if (name == "bench") return checked(std::move(parsed.bench), options);
  parsed.view.program = parsed.render.program = parsed.program;
  if (name == "view") return with_frames(std::move(parsed.view));
  if (name == "precompute") return with_frames(std::move(parsed.precompute));
  if (name == "info") return with_overrides(std::move(parsed.info));
  if (name == "merge") return checked(with_log(std::move(parsed.merge)), parsed);
  parsed.render.command_line = shell_quoted(parsed.program) + parsed.words;
  if (name == "turntable") parsed.render.frames = parse_frames("1-" + std::to_string(options.turn_frames));
  RenderArguments render = checked(with_frames(std::move(parsed.render)), options);
  if (name == "turntable") return TurntableArguments{render, render.log};
  return render;
}

}  // namespace

OutputFormat output_format(const std::string& path) {
  const std::string extension = in_lower_case(std::filesystem::path(path).extension().string());
  return extension == ".exr"    ? OutputFormat::exr
         : extension == ".png"  ? OutputFormat::png
         : extension == ".mp4"  ? OutputFormat::mp4
         : extension == ".part" ? OutputFormat::part
                                : OutputFormat::unknown;
}

Command parse_arguments(int argc, const char* const* argv) {
  CLI::App app("opaline renders translucent assets fast and reports how accurate each image is.", "opaline");
  app.get_formatter()->column_width(34);
  app.set_version_flag("--version", "opaline " OPALINE_VERSION, "print the version");
  app.set_help_flag("-h,--help", "print this help");
  app.require_subcommand(0, 1);  // a missing command is handled below: CLI11 would hide a misspelt one
  app.footer(kExamples);
  Parsed parsed;
  add_commands(app, parsed);
  try {
    std::vector<std::string> words = words_of(app, argc, argv);
    std::ranges::reverse(words);  // as CLI11 takes them
    app.parse(std::move(words));
  } catch (const CLI::ParseError& failure) {
    if (failure.get_exit_code() == 0) return shown_text(app, failure);
    throw parse_error(app, failure);
  }
  const std::vector<CLI::App*> called = app.get_subcommands();
  if (called.empty()) throw no_command(app);
  const std::string name = called.front()->get_name();
  if (name == "schema") return ShowText{json_schema()};
  if (name == "completion") return ShowText{bash_completion(app)};
  parsed.program = argv[0];
  for (int i = 1; i < argc; ++i) parsed.words += ' ' + shell_quoted(argv[i]);
  return command_of(name, std::move(parsed));
}

bool asks_for_json(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--json" || word == "--log=json" ||
        (word == "json" && argv[i - 1] == std::string_view("--log")))
      return true;
  }
  return false;
}

Error placed_at_option(const Error& failure, int argc, const char* const* argv) {
  constexpr std::string_view set = "--set ";
  if (!failure.file.starts_with(set)) return failure;
  const std::string given = failure.file.substr(set.size()), name = given.substr(0, given.find('='));
  if (const std::string_view key = key_of_option("--" + name);
      !key.empty() && failure.message.find("did you mean") == std::string::npos)
    return Error(failure.kind, failure.file, 0, 0,
                 fmt::format("{} (did you mean '{}'?)", failure.message, key));
  const std::string_view option = option_of_key(name);
  const bool is_set = std::any_of(argv + 1, argv + argc, [&](const char* word) {
    return printable(word) == given || printable(word) == "--set=" + given;
  });
  if (option.empty() || is_set) return failure;
  return Error(failure.kind, std::string(option), failure.line, failure.column, failure.message,
               failure.expected, failure.got);
}

}  // namespace opaline
