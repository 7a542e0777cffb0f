// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>

#include "opaline/core/error.h"
#include "scene/json_tree.h"
#include "scene/schema.h"

namespace opaline {
namespace {

constexpr const char* kExamples = R"(Examples:
  opaline info bunny.json
  opaline render bunny.json -o bunny.exr -o bunny.png
  opaline render bunny.json -o draft.png --method lambert --resolution 256x256
  opaline render bunny.json -o warm.exr --set media.marble.eta=1.4 --set lights.back.intensity=[9e4,7e4,5e4]
  opaline render bunny.json -o reference.exr --method direct --until-error 2% --resume sums.exr
  opaline render bunny.json -o bunny.exr --log json --threads 4

Exit codes: 0 done, 2 bad input, 3 the run failed (I/O, memory), 130 interrupted (Ctrl-C; old files stay).)";

constexpr const char* kRenderNotes = R"(Every option that changes the picture is short for a --set:
  --spp 4            --set film.samples_per_pixel=4
  --resolution 64x48 --set film.resolution=[64,48]
  --crop 0,0,16,16   --set film.crop=[0,0,16,16]
  --method, --evaluator, --seed, --entry-samples, --until-error: --set settings.<name>=...
  --exposure: --set film.exposure=...
They are applied first, then each --set in its order: the last one wins.)";

/// What the options of both commands write to, before it becomes overrides.
struct Options {
  std::string method, evaluator, resolution, crop;
  std::string until_error;
  std::optional<std::uint64_t> entry_samples;
  std::optional<std::uint64_t> spp;
  std::optional<std::uint64_t> seed;
  std::optional<double> exposure;
  std::vector<std::string> sets;
  std::string log = "text";
};

struct WholeRange {
  std::uint64_t low, high;
};

// As the scene's check has them: here the message can name the option.
constexpr WholeRange kSpp{1, 65536}, kSide{1, 65536}, kPixel{0, 65536}, kSeed{0, UINT64_MAX},
    kThreads{1, 4096}, kEntrySamples{1, 1000000000};

/// "640x480" -> "[640,480]"; empty if it is not `count` whole numbers in the range with the separator between
/// them.
std::string json_list(std::string_view text, char separator, std::size_t count, WholeRange range) {
  std::vector<std::uint64_t> numbers;
  const char *at = text.data(), *end = text.data() + text.size();
  while (numbers.size() < count) {
    std::uint64_t& number = numbers.emplace_back();
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc{} || number < range.low || number > range.high) return {};
    if (next == end) break;
    if (*next != separator) return {};
    at = next + 1;
    if (numbers.size() == count) return {};
  }
  if (numbers.size() != count) return {};
  return fmt::format("[{}]", fmt::join(numbers, ","));
}

/// "0.5%" or "0.005"; nothing if it is neither.
std::optional<double> fraction(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{}) return std::nullopt;
  if (next == end) return value;
  if (next + 1 == end && *next == '%') return value / 100;
  return std::nullopt;
}

std::string fraction_check(const std::string& text) {
  return fraction(text) ? std::string() : fmt::format("expected a percentage such as 0.5%, got {}", text);
}

std::string resolution_json(std::string_view text) {
  return json_list(text, 'x', 2, kSide);
}
std::string crop_json(std::string_view text) {
  return json_list(text, ',', 4, kPixel);
}

CLI::Validator list_check(std::string (*json)(std::string_view), const std::string& form) {
  return CLI::Validator(
      [=](std::string& text) {
        return json(text).empty() ? fmt::format("expected {}, got {}", form, text) : std::string();
      },
      {});
}

/// CLI11 would let a number beyond 64 bits wrap or stop at the end, and take 010 for 8.
CLI::Validator whole_number(WholeRange range) {
  return CLI::Validator(
      [=](std::string& text) {
        std::uint64_t number = 0;
        const char* end = text.data() + text.size();
        const auto [next, error] = std::from_chars(text.data(), end, number);
        if (error != std::errc{} || next != end || number < range.low || number > range.high)
          return fmt::format("expected a whole number from {} to {}, got {}", range.low, range.high, text);
        text = std::to_string(number);
        return std::string();
      },
      {});
}

/// CLI11 would take everything after `-o a.exr` for more outputs: one value an option, as often as wanted.
template <class T>
CLI::Option* add_repeatable(CLI::App& app, const std::string& names, std::vector<T>& values,
                            const std::string& help) {
  return app.add_option(names, values, help)->allow_extra_args(false);
}

void add_common_options(CLI::App& app, std::string& scene, Options& options) {
  app.add_option("SCENE", scene, "scene file (JSON with comments)")->required()->type_name("FILE");
  add_repeatable(app, "--set", options.sets,
                 "change any value of the scene, e.g. media.marble.eta=1.4; repeatable")
      ->type_name("KEY=VALUE");
  app.add_option("--log", options.log, "text, or json: one object a line on stdout")
      ->check(CLI::IsMember({"text", "json"}).description(""))
      ->type_name("text|json");
}

void add_picture_options(CLI::App& app, Options& options) {
  const char* group = "Picture";
  app.add_option("--spp", options.spp, "samples per pixel")
      ->transform(whole_number(kSpp))
      ->type_name("N")
      ->group(group);
  app.add_option("--resolution", options.resolution, "width and height, e.g. 640x480")
      ->check(list_check(resolution_json, "WIDTHxHEIGHT, each 1 to 65536, such as 640x480"))
      ->type_name("WxH")
      ->group(group);
  app.add_option("--crop", options.crop, "only these pixels, from the top left; x1 and y1 excluded")
      ->check(list_check(crop_json, "four numbers x0,y0,x1,y1, each 0 to 65536"))
      ->type_name("x0,y0,x1,y1")
      ->group(group);
  app.add_option("--exposure", options.exposure, "stops, PNG only")->type_name("STOPS")->group(group);
  app.add_option(
         "--method", options.method,
         "hierarchical: light under the surface; lambert: plain paint, fast; direct: the reference, slow")
      ->type_name("NAME")
      ->group(group);
  app.add_option("--evaluator", options.evaluator,
                 "classic: octree traversal; brute_force: the exact sum, slow")
      ->type_name("NAME")
      ->group(group);
  app.add_option("--entry-samples", options.entry_samples, "direct: places of entry for each pixel")
      ->transform(whole_number(kEntrySamples))
      ->type_name("N")
      ->group(group);
  app.add_option("--until-error", options.until_error, "direct: stop at this noise of the pixels, e.g. 0.5%")
      ->check(CLI::Validator([](std::string& text) { return fraction_check(text); }, {}))
      ->type_name("PERCENT")
      ->group(group);
  app.add_option("--seed", options.seed, "of all random numbers")
      ->transform(whole_number(kSeed))
      ->type_name("N")
      ->group(group);
}

void add_render_options(CLI::App& app, RenderArguments& render, Options& options) {
  add_repeatable(app, "-o,--output", render.outputs, "picture to write, .exr or .png; repeatable")
      ->required()
      ->type_name("FILE");
  add_common_options(app, render.scene, options);
  app.add_option("--samples-ply", render.samples_ply, "also write the surface samples as a PLY point cloud")
      ->type_name("FILE");
  app.add_option(
         "--resume", render.resume,
         "direct: go on from this file's sums if it is there; they are written to it every minute, at the "
         "end and on Ctrl-C")
      ->type_name("FILE")
      ->check(CLI::Validator(
          [](std::string& path) {
            return path.ends_with(".exr") ? std::string()
                                          : fmt::format("expected a name that ends in .exr, got {}", path);
          },
          {}));
  app.add_option("--threads", render.threads, "at most this many; default: one for each core")
      ->transform(whole_number(kThreads))
      ->type_name("N");
  app.add_flag("--quiet", render.log.quiet, "print warnings and errors only");
  app.add_flag("--timings-in-metadata", render.timings_in_metadata,
               "store the time of each stage in the EXR; its bytes then differ between runs");
  add_picture_options(app, options);
  app.footer(kRenderNotes);
}

std::vector<std::string> overrides_of(const Options& options) {
  std::vector<std::string> overrides;
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) overrides.push_back(fmt::format("{}={}", key, value));
  };
  if (options.spp) add("film.samples_per_pixel", std::to_string(*options.spp));
  if (!options.resolution.empty()) add("film.resolution", resolution_json(options.resolution));
  if (!options.crop.empty()) add("film.crop", crop_json(options.crop));
  if (options.exposure) add("film.exposure", fmt::format("{}", *options.exposure));
  if (options.entry_samples) add("settings.entry_samples", std::to_string(*options.entry_samples));
  if (!options.until_error.empty())
    add("settings.until_error", fmt::format("{}", *fraction(options.until_error)));
  add("settings.method", options.method);
  add("settings.evaluator", options.evaluator);
  if (options.seed) add("settings.seed", std::to_string(*options.seed));
  overrides.insert(overrides.end(), options.sets.begin(), options.sets.end());
  return overrides;
}

Error usage_error(const std::string& message, const std::string& expected = {}, const std::string& got = {}) {
  return Error(ErrorKind::bad_input, {}, 0, 0, message, expected, got);
}

void check_outputs(const RenderArguments& render) {
  std::set<std::string> seen;
  for (const std::string& path : render.outputs) {
    if (output_format(path) == OutputFormat::unknown)
      throw usage_error("cannot tell the format of the output", "a name that ends in .exr or .png",
                        "'" + path + "'");
    if (!seen.insert(path).second) throw usage_error("two outputs have the same name '" + path + "'");
  }
  if (seen.contains(render.samples_ply))
    throw usage_error("two outputs have the same name '" + render.samples_ply + "'");
}

/// Help and version are exceptions of CLI11 too.
ShowText shown_text(CLI::App& app, const CLI::ParseError& request) {
  std::ostringstream out, error;
  app.exit(request, out, error);
  std::string text = out.str();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return {text};
}

std::string hint(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return fmt::format("; see opaline {}--help", chosen.empty() ? "" : chosen.front()->get_name() + " ");
}

/// What CLI11 calls an argument too many is a mistyped command if it stands where the command belongs.
Error parse_error(const CLI::App& app, const CLI::ParseError& failure) {
  const std::vector<std::string> extras = app.remaining();
  if (!app.get_subcommands().empty() || extras.empty() || extras.front().starts_with('-'))
    return usage_error(failure.what() + hint(app));
  constexpr std::array<std::string_view, 2> commands{"render", "info"};
  const std::string near = did_you_mean(extras.front(), commands);
  return usage_error("unknown command '" + printable(extras.front()) + "'" + near,
                     near.empty() ? "one of " + join(commands) : "");
}

}  // namespace

OutputFormat output_format(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
  return extension == ".exr"   ? OutputFormat::exr
         : extension == ".png" ? OutputFormat::png
                               : OutputFormat::unknown;
}

Command parse_arguments(int argc, const char* const* argv) {
  RenderArguments render;
  InfoArguments info;
  Options options;
  CLI::App app("opaline renders translucent things fast, and says how accurate the picture is.", "opaline");
  app.get_formatter()->column_width(34);
  app.set_version_flag("--version", "opaline " OPALINE_VERSION, "print the version");
  app.set_help_flag("-h,--help", "print this help");
  app.require_subcommand(0, 1);  // none at all is answered below: CLI11 would hide a misspelt one behind it
  app.footer(kExamples);
  CLI::App& render_command = *app.add_subcommand("render", "render a scene to EXR and PNG files");
  CLI::App& info_command =
      *app.add_subcommand("info", "print what a scene requires and why; nothing is rendered");
  add_render_options(render_command, render, options);
  add_common_options(info_command, info.scene, options);
  add_picture_options(info_command, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& failure) {
    if (failure.get_exit_code() == 0) return shown_text(app, failure);
    throw parse_error(app, failure);
  }
  if (app.get_subcommands().empty()) throw usage_error("no command given: render or info" + hint(app));
  const LogFormat format = options.log == "json" ? LogFormat::json : LogFormat::text;
  info.log.format = render.log.format = format;
  info.overrides = render.overrides = overrides_of(options);
  if (info_command.parsed()) return info;
  check_outputs(render);
  return render;
}

}  // namespace opaline
