// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "cli/help_texts.h"
#include "cli/option_helpers.h"
#include "cli/option_values.h"
#include "input/schema.h"

namespace opaline {
namespace {

void add_frames_option(CLI::App& app, Options& options, const char* meaning) {
  app.add_option("--frames", options.frames,
                 fmt::format("frame range, e.g. 1-24, 1-24x2 or 1,5,7-9; {}", meaning))
      ->type_name("FRAMES");
}

void add_log_option(CLI::App& app, Options& options) {
  app.add_option("--log", options.log, "format of the log: text, or json (one object per line on stdout)")
      ->check(log_check())
      ->type_name("text|json");
}

/// The scene's documentation without its Markdown.
std::string plain_text(std::string_view markdown) {
  std::string text;
  for (const char c : markdown)
    if (c != '`' && c != '"') text += c;
  return text;
}

/// Adds an option for a key of film or settings, with its documentation and the range of whole numbers.
template <class T>
CLI::Option* add_key(CLI::App& app, T& value, std::string_view path) {
  const std::size_t dot = path.find('.');
  const KeyInfo& info = key_info(path.substr(0, dot), path.substr(dot + 1));
  CLI::Option* option = app.add_option(
      std::string(option_of_key(path)), value,
      fmt::format("{} (default {})", plain_text(info.meaning), plain_text(info.default_value)));
  if (info.type == ValueType::whole_number) option->transform(whole_number(info.range));
  return option;
}

struct KeyOption {
  std::string_view key, option;
};

constexpr KeyOption kKeyOptions[] = {{"film.samples_per_pixel", "--spp"},
                                     {"film.resolution", "--resolution"},
                                     {"film.crop", "--crop"},
                                     {"film.exposure", "--exposure"},
                                     {"film.view", "--view"},
                                     {"settings.method", "--method"},
                                     {"settings.evaluator", "--evaluator"},
                                     {"settings.entry_samples", "--entry-samples"},
                                     {"settings.until_error", "--until-error"},
                                     {"settings.seed", "--seed"},
                                     {"lights", "--environment"}};

}  // namespace

std::string_view option_of_key(std::string_view key) {
  const auto found = std::ranges::find(kKeyOptions, key, &KeyOption::key);
  return found == std::end(kKeyOptions) ? std::string_view() : found->option;
}

std::string_view key_of_option(std::string_view option) {
  const auto found = std::ranges::find(kKeyOptions, option, &KeyOption::option);
  return found == std::end(kKeyOptions) ? std::string_view() : found->key;
}

/// Options of commands writing images.
void add_image_options(CLI::App& app, RenderArguments& render, Options& options, const char* outputs) {
  add_repeatable(app, "-o,--output", render.outputs, outputs)->required()->type_name("FILE");
  add_common_options(app, render.scene, options);
  app.add_option("--layers", options.layers,
                 "layers of the EXR besides R, G, B and A: diffuse (default), specular, albedo, N, P, Z, "
                 "irradiance, error, variance (of direct); all (of these) or none; also light_groups (the "
                 "contribution of each light), cryptomatte (mattes of objects and materials) and wavelengths "
                 "(radiance at each wavelength of a scene with spectra)")
      ->check(layers_check())
      ->type_name("NAME,...");
  CLI::Option* cache = app.add_option("--cache", render.cache,
                                      "store samples, irradiance and octrees in this folder, and reuse the "
                                      "entries with the same input")
                           ->type_name("FOLDER");
  add_size(app, "--cache-size", render.cache_bytes,
           "maximum cache size, e.g. 20GB (default 8GB); evicts the least recently used entries")
      ->needs(cache);
  app.add_option("--fps", render.frames_per_second, "frames per second of a movie (default 24)")
      ->transform(whole_number({1, 240}))
      ->type_name("N");
  add_threads(app, render.threads, "maximum number of threads (default: one per core)");
  app.add_flag("--quiet", render.log.quiet, "print warnings and errors only");
  app.add_flag("--timings-in-metadata", render.timings_in_metadata,
               "store the time of each stage in the EXR; the file then differs between runs");
  add_picture_options(app, options);
  app.add_option("--target-error", options.target_error,
                 "choose samples, tolerance and evaluator for this error at the lowest cost, e.g. 1%")
      ->check(positive_share_check())
      ->type_name("PERCENT")
      ->group("Quality");
}

void add_asset_options(CLI::App& app, Options& options) {
  add_repeatable(app, "--medium", options.media,
                 "medium of all shapes, or of one (SHAPE=NAME): a preset such as marble, or a medium of the "
                 "scene; repeatable")
      ->type_name("NAME");
  app.add_option("--size", options.size,
                 "largest side of the box around all shapes of the file, e.g. 50mm or 1.7m; sets mm_per_unit")
      ->transform(millimetres_of())
      ->type_name("LENGTH");
}

void add_common_options(CLI::App& app, std::string& scene, Options& options) {
  app.add_option("SCENE", scene,
                 "scene file (JSON with comments) or asset (.glb, .gltf, .obj, .ply, .stl, .off)")
      ->required()
      ->type_name("FILE");
  add_repeatable(app, "--set", options.sets,
                 "override a value of the scene, e.g. media.marble.specular_ior=1.4; repeatable")
      ->type_name("KEY=VALUE");
  add_asset_options(app, options);
  add_allow_outside(app);
  add_log_option(app, options);
}

void add_picture_options(CLI::App& app, Options& options) {
  const auto option = [&](auto& value, const char* key, const char* type) {
    return add_key(app, value, key)->type_name(type)->group("Image");
  };
  option(options.spp, "film.samples_per_pixel", "N");
  option(options.resolution, "film.resolution", "WxH")->check(resolution_check());
  option(options.crop, "film.crop", "x0,y0,x1,y1")->check(crop_check());
  option(options.exposure, "film.exposure", "STOPS")->check(number_check());
  option(options.view, "film.view", "NAME");
  app.add_option("--environment", options.environment,
                 "lat-long environment map (EXR, HDR, PNG) that replaces the lights of the scene; sets the "
                 "exposure to 0")
      ->type_name("FILE")
      ->group("Image");
  app.add_flag("--denoise", options.denoise,
               "remove noise with Open Image Denoise, if it is installed (film.denoise)")
      ->group("Image");
  option(options.method, "settings.method", "NAME");
  option(options.evaluator, "settings.evaluator", "NAME");
  option(options.entry_samples, "settings.entry_samples", "N");
  option(options.until_error, "settings.until_error", "PERCENT")->check(positive_share_check());
  option(options.seed, "settings.seed", "N");
}

void add_render_options(CLI::App& app, RenderArguments& render, Options& options) {
  add_image_options(app, render, options,
                    "image to write, .exr or .png; with --frames also a movie, .mp4 (by ffmpeg); repeatable");
  app.add_option("--samples-ply", render.samples_ply, "also write the surface samples as a PLY point cloud")
      ->type_name("FILE")
      ->check(extension_check(".ply"));
  app.add_option("--resume", render.resume,
                 "direct, volume: resume from the sums in this file if it exists; stores the sums every "
                 "minute, at the end and on Ctrl-C")
      ->type_name("FILE")
      ->check(extension_check(".exr"));
  app.add_option("--part", options.part,
                 "direct, volume: render part K of N only, e.g. 2/8, to -o FILE.part; opaline merge adds all "
                 "parts to the image")
      ->check(part_check())
      ->type_name("K/N");
  add_frames_option(app, options,
                    "## in output and mesh names stands for the frame number; existing frames of the same "
                    "scene are skipped");
  const char* quality = "Quality";
  app.add_option(
         "--time-budget", options.time_budget,
         "choose samples, tolerance and evaluator, or cells, for the lowest error within this total CPU "
         "time, e.g. 2s; direct stops at this time")
      ->transform(seconds_of())
      ->type_name("TIME")
      ->group(quality);
  app.add_flag("--verify", render.verify, "measure the error at some 200 points with --method direct")
      ->group(quality);
  app.footer(kRenderNotes);
}

void add_turntable_options(CLI::App& app, RenderArguments& render, Options& options) {
  add_image_options(
      app, render, options,
      "movie to write, .mp4 (by ffmpeg), or images, .exr or .png, with ## for the frame number; "
      "repeatable");
  app.add_option("--frames", options.turn_frames, "number of frames of the turn (default 48)")
      ->transform(whole_number({2, 100000}))
      ->type_name("N");
  app.footer(kTurntableNotes);
}

void add_view_options(CLI::App& app, ViewArguments& view, Options& options) {
  add_common_options(app, view.scene, options);
  app.get_option("SCENE")->required(false)->description(
      "scene file or asset (default: files dropped onto the page)");
  app.add_option("--listen", view.options.address,
                 "IP address to listen on (default 127.0.0.1: this machine only; 0.0.0.0: all networks)")
      ->type_name("ADDRESS");
  app.add_option("--port", view.options.port, "port to listen on (default: any free port)")
      ->transform(whole_number(kPorts))
      ->type_name("N");
  app.add_option("--token", view.options.token,
                 "secret token in the URL, 16 to 64 characters (default: random)")
      ->type_name("WORD");
  add_frames_option(
      app, options,
      "## in mesh names stands for the frame number; default: from the first key of the scene to the last");
  add_threads(app, view.threads, "maximum number of threads (default: one per core)");
  app.add_flag_callback(
      "--no-open", [&view] { view.opens_browser = false; }, "do not open the URL in the browser");
  app.add_flag("--quiet", view.log.quiet, "print the URL and errors only");
  add_picture_options(app, options);
  app.footer(kViewNotes);
}

void add_merge_options(CLI::App& app, MergeArguments& merge, Options& options) {
  app.add_option("PART", merge.parts,
                 "all parts of one image, written by opaline render --part, in any order")
      ->required()
      ->type_name("FILE");
  add_repeatable(app, "-o,--output", merge.render.outputs, "image to write, .exr or .png; repeatable")
      ->required()
      ->type_name("FILE");
  add_threads(app, merge.render.threads, "maximum number of threads (default: one per core)");
  add_allow_outside(app);
  app.add_flag("--quiet", merge.log.quiet, "print warnings and errors only");
  add_log_option(app, options);
  app.footer(kMergeNotes);
}

void add_precompute_options(CLI::App& app, PrecomputeArguments& precompute, Options& options) {
  add_common_options(app, precompute.scene, options);
  app.add_option("--cache", precompute.cache, "folder of the cache")->required()->type_name("FOLDER");
  add_size(app, "--cache-size", precompute.cache_bytes,
           "maximum cache size (default 8GB); evicts the least recently used entries");
  add_frames_option(app, options, "## in mesh names stands for the frame number");
  add_threads(app, precompute.threads, "maximum number of threads (default: one per core)");
  app.add_flag("--quiet", precompute.log.quiet, "print warnings and errors only");
}

}  // namespace opaline
