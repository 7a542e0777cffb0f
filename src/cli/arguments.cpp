// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>

#include "cli/frames.h"
#include "cli/metadata.h"
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
  opaline compare bunny.exr reference.exr --fail-above 1%
  opaline bench bunny.json -o report --resolution 256x256
  opaline render bunny.json -o turned.exr --cache stages --set camera.position=[0,50,200]
  opaline render bunny.json -o out.####.exr --frames 1-24 --cache stages
  opaline cache ls stages

Exit codes: 0 done, 1 a comparison failed, 2 bad input, 3 the run failed (I/O, memory), 130 interrupted (Ctrl-C; old files stay).)";

constexpr const char* kRenderNotes = R"(Every option that changes the picture is short for a --set:
  --spp 4            --set film.samples_per_pixel=4
  --resolution 64x48 --set film.resolution=[64,48]
  --crop 0,0,16,16   --set film.crop=[0,0,16,16]
  --method, --evaluator, --seed, --entry-samples, --until-error: --set settings.<name>=...
  --exposure: --set film.exposure=...
They are applied first, then each --set in its order: the last one wins.)";

constexpr const char* kCompareNotes =
    R"(Figures are of the relative error (a - b) / max(|b|, floor), floor being 1e-3 of the p99 of |b|, over the
pixels that show an object: coverage A > 0 in the reference, or all of them if it has no A.
  mean       of the absolute relative error; this is what --fail-above looks at
  relMSE     mean of its square
  p99, max   what 99 % and all of the values do not exceed
  signed     mean with the sign: above 0 where the picture is too bright
  FLIP       what a person sees who flips between the two: 0 nothing, 1 all (LDR-FLIP, 67 pixels a degree),
             on the sRGB pictures after --exposure
NaN and infinities are counted, and enter no mean; any in the picture fails the comparison.

--halves takes two references with independent noise, such as two seeds, and prints the error that their noise
does not raise: err^2 = mean of (h - d1)(h - d2) / (d^2 + (.01 max d)^2), d the mean of both. Below 0 it is
'below noise'; not above twice its standard error it says nothing. What is wrong with both halves stays.

Error pictures: .png shows the largest error over the channels from black (.01 % or less) over violet, red (1 %)
and orange to white (100 % or more); grey: no object; green: not finite. .exr holds the signed relative errors.

Examples:
  opaline compare a.exr b.exr --error-picture error.png
  opaline compare a.exr b.exr --layer diffuse --fail-above 1% --json
  opaline compare a.exr --halves seed1.exr seed2.exr

Exit codes: 0 done, 1 above the bound or not finite, 2 bad input, 3 the error picture cannot be written.)";

constexpr const char* kBenchNotes =
    R"(For each scene: lambert, hierarchical and direct at several settings, each run a process of its own, the
repeats of all taking turns. Prints medians, and ratios to lambert (CPU of the whole job, of the shading pass)
of one round each; the CSV has all figures with their smallest and largest values, and the machine.

error     rms relative error against two halves of a reference (compare --halves), worst channel;
          "< 2": what could be told from the noise of the halves begins at 2 %
p99       against the mean of the halves; in brackets the p99 of that mean's own noise

-o writes a report into a folder: index.html (open it in a browser; no network is needed) with the trade of
error against CPU time, pictures and where they are off, and the parts of the error, each rendered alone; the
same figures as results.csv, budget.csv and results.json; pictures. Run it again after an interruption: what
this program has finished on the same scene and settings is kept there and not repeated (a ratio then may pair
runs from before and after).

--against compares ratios to lambert and errors with an earlier results.json, rung by rung, and exits with 1 if
one is worse beyond the noise: the ranges of a ratio lie apart by more than half their widths together, an
error's square by more than three of its standard errors; less than 5 % is never a change.

Halves that the bench renders are kept (--reference-dir) and used again while scene, meshes and settings are
the same; delete them when `direct` itself has changed. An interrupted one goes on where it stopped.

Examples:
  opaline bench bunny.json -o report --quick
  opaline bench bunny.json ball.json -o report --resolution 256x256 --repeats 5
  opaline bench bunny.json -o new --resolution 256x256 --against report/results.json
  opaline bench bunny.json --csv bunny.csv --halves seed1.exr seed2.exr --rung near_field=false

Exit codes: 0 done, 1 worse than before (--against), 2 bad input, 3 a rung failed (its row says why) or the run
did, 130 interrupted.)";

constexpr const char* kCacheNotes =
    R"(An entry holds the result of one stage for one input: the samples of a group, the light that enters
them from one light, or their tree. Its name ends in the key of that input. Entries are HDF5 files behind a
header with a hash of the rest; one that does not match it is never read, but computed again.

Exit codes: 0 done, 1 an entry cannot be used, 2 bad input, 3 the folder cannot be read or written.)";

/// What the options of render and info write to, before it becomes overrides.
struct Options {
  std::string method, evaluator, resolution, crop;
  std::string until_error;
  std::optional<std::uint64_t> entry_samples;
  std::optional<std::uint64_t> spp;
  std::optional<std::uint64_t> seed;
  std::optional<double> exposure;
  std::vector<std::string> sets;
  std::string log = "text";
  std::string fail_above;
  bool json = false;
  std::string reference_error;
  std::vector<std::string> rungs;
  std::string frames;
};

struct WholeRange {
  std::uint64_t low, high;
};

// As the scene's check has them: here the message can name the option.
constexpr WholeRange kSpp{1, 65536}, kSide{1, 65536}, kPixel{0, 65536}, kSeed{0, UINT64_MAX},
    kThreads{1, 4096}, kEntrySamples{1, 1000000000}, kRepeats{3, 1000};

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

CLI::Option* add_size(CLI::App& app, const std::string& name, std::uint64_t& bytes, const std::string& help) {
  return app.add_option(name, bytes, help)
      ->transform(CLI::AsSizeValue(true).description(""))
      ->type_name("SIZE");
}

void add_frames_option(CLI::App& app, Options& options) {
  app.add_option(
         "--frames", options.frames,
         "frames of a range, e.g. 1-24, 1-24x2 or 1,5,7-9; ## in the names of outputs and meshes is their "
         "number; frames that are there already are left alone")
      ->check(CLI::Validator(
          [](std::string& text) {
            return parse_frames(text) ? std::string()
                                      : "expected frames such as 1-24 or 1,5,7-9, got " + text;
          },
          {}))
      ->type_name("FRAMES");
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
                 "dual_tree: to settings.tolerance; surface_cache: the same, interpolated; classic: as published; "
                 "brute_force: the exact sum, slow; default: automatic, one of the first two")
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
  app.add_option("--cache", render.cache,
                 "keep samples, irradiance and trees in this folder, and take from it what was computed from "
                 "the same")
      ->type_name("FOLDER");
  add_frames_option(app, options);
  add_size(app, "--cache-size", render.cache_bytes,
           "the least recently used beyond it go, e.g. 20GB (default 8GB)");
  app.add_option("--threads", render.threads, "at most this many; default: one for each core")
      ->transform(whole_number(kThreads))
      ->type_name("N");
  app.add_flag("--quiet", render.log.quiet, "print warnings and errors only");
  app.add_flag("--timings-in-metadata", render.timings_in_metadata,
               "store the time of each stage in the EXR; its bytes then differ between runs");
  add_picture_options(app, options);
  app.footer(kRenderNotes);
}

/// "1%" or ".01" -> .01; nothing if it is neither, or below 0.
std::optional<double> share_of(std::string_view text) {
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  while (percent && text.ends_with(' ')) text.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0) || std::isinf(value))
    return std::nullopt;
  return percent ? value / 100 : value;
}

void add_compare_options(CLI::App& app, CompareArguments& compare, Options& options) {
  app.add_option("A", compare.picture, "the picture under test, EXR or PNG")->required()->type_name("FILE");
  app.add_option("B", compare.reference, "the reference, EXR or PNG")->type_name("FILE");
  app.add_option("--halves", compare.halves, "in place of B: two references with independent noise")
      ->expected(2)
      ->type_name("FILE");
  app.add_option("--layer", compare.layer, "a layer of the EXR, e.g. diffuse; default: R, G, B")
      ->type_name("NAME");
  app.add_option("--fail-above", options.fail_above,
                 "exit 1 if a channel's mean relative error is above; e.g. 1% or .01")
      ->check(CLI::Validator(
          [](std::string& text) {
            return share_of(text) ? std::string() : "expected a share such as 1% or .01, got " + text;
          },
          {}))
      ->type_name("SHARE");
  app.add_option("--error-picture", compare.error_picture, "write where the errors are, .png or .exr")
      ->type_name("FILE");
  app.add_option("--exposure", compare.exposure,
                 "stops, for FLIP; default: 0 for PNG, else what turns the p99 of B white")
      ->type_name("STOPS");
  app.add_flag("--json", options.json, "the result as one JSON object on stdout");
  app.footer(kCompareNotes);
}

std::string positive_share_check(const std::string& text) {
  const std::optional<double> share = share_of(text);
  return share && *share > 0 && *share <= 1 ? std::string()
                                            : "expected a share such as 2% or .02, got " + text;
}

std::string rung_check(const std::string& text) {
  const std::size_t equals = text.find('=');
  return equals != std::string::npos && equals > 0 && equals + 1 < text.size()
             ? std::string()
             : "expected a setting such as near_field=false, got " + text;
}

void add_bench_options(CLI::App& app, BenchArguments& bench, Options& options) {
  app.add_option("SCENE", bench.scenes, "scene files (JSON with comments)")->required()->type_name("FILE");
  app.add_option("-o,--output", bench.report, "write a report into this folder")->type_name("FOLDER");
  app.add_option("--csv", bench.csv, "write all figures")->type_name("FILE");
  app.add_option("--against", bench.against,
                 "results.json of an earlier report: exit 1 if something got worse")
      ->type_name("FILE");
  app.add_option("--resolution", options.resolution, "width and height of all pictures, e.g. 256x256")
      ->check(list_check(resolution_json, "WIDTHxHEIGHT, each 1 to 65536, such as 640x480"))
      ->type_name("WxH");
  add_repeatable(app, "--set", options.sets, "change any value of the scenes; repeatable")
      ->type_name("KEY=VALUE");
  add_repeatable(app, "--rung", options.rungs,
                 "one more hierarchical rung, with this one of the scene's settings; repeatable")
      ->check(CLI::Validator([](std::string& text) { return rung_check(text); }, {}))
      ->type_name("NAME=VALUE");
  app.add_option("--repeats", bench.repeats, "runs of each rung, at least 3 (default 3)")
      ->transform(whole_number(kRepeats))
      ->type_name("N");
  app.add_option("--threads", bench.threads, "of each run (default 1)")
      ->transform(whole_number(kThreads))
      ->type_name("N");
  app.add_option("--halves", bench.halves, "two references with independent noise, of a single scene")
      ->expected(2)
      ->type_name("FILE");
  app.add_option("--reference-error", options.reference_error,
                 "noise of each half that the bench renders (default 2%, 3% with --quick)")
      ->check(CLI::Validator([](std::string& text) { return positive_share_check(text); }, {}))
      ->type_name("SHARE");
  app.add_option("--reference-dir", bench.reference_dir,
                 "keeps these halves; default: references in the report or beside the CSV")
      ->type_name("FOLDER");
  app.add_flag("--quick", bench.quick, "to try it: few rungs, 128 pixels wide");
  app.footer(kBenchNotes);
}

void add_precompute_options(CLI::App& app, PrecomputeArguments& precompute, Options& options) {
  add_common_options(app, precompute.scene, options);
  app.add_option("--cache", precompute.cache, "the folder to fill")->required()->type_name("FOLDER");
  add_size(app, "--cache-size", precompute.cache_bytes, "the least recently used beyond it go (default 8GB)");
  add_frames_option(app, options);
  app.add_option("--threads", precompute.threads, "at most this many; default: one for each core")
      ->transform(whole_number(kThreads))
      ->type_name("N");
  app.add_flag("--quiet", precompute.log.quiet, "print warnings and errors only");
}

void add_cache_commands(CLI::App& app, CacheArguments& cache, Options& options) {
  const auto add = [&](const char* name, CacheAction action, const char* help) {
    CLI::App& command = *app.add_subcommand(name, help);
    command.add_option("FOLDER", cache.folder, "what --cache named")->required()->type_name("FOLDER");
    command.add_flag("--json", options.json, "the result as one JSON object on stdout");
    command.parse_complete_callback([&cache, action] { cache.action = action; });
    return &command;
  };
  add("ls", CacheAction::list, "print the entries, the least recently used first");
  add("verify", CacheAction::verify, "read every entry whole; exit 1 if one is damaged");
  CLI::App& prune = *add("prune", CacheAction::prune, "remove the least recently used entries");
  add_size(prune, "--size", cache.most_bytes, "what may stay, e.g. 500MB (default 8GB)");
  app.require_subcommand(1);
  app.footer(kCacheNotes);
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

Error unknown_format(const std::string& path) {
  return usage_error("cannot tell the format of the output", "a name that ends in .exr or .png",
                     "'" + path + "'");
}

void check_outputs(const RenderArguments& render) {
  std::set<std::string> seen;
  for (const std::string& path : render.outputs) {
    if (output_format(path) == OutputFormat::unknown) throw unknown_format(path);
    if (!seen.insert(path).second) throw usage_error("two outputs have the same name '" + path + "'");
  }
  if (seen.contains(render.samples_ply))
    throw usage_error("two outputs have the same name '" + render.samples_ply + "'");
  std::vector<std::string> files = render.outputs;
  for (const std::string& more : {render.samples_ply, render.resume})
    if (!more.empty()) files.push_back(more);
  for (const std::string& path : files)
    if (!render.frames.empty() && path.find("##") == std::string::npos)
      throw usage_error("all frames would be written to '" + path + "'",
                        "## for their number, as in out.####.exr");
}

CompareArguments checked(CompareArguments compare, const Options& options) {
  if (compare.reference.empty() == compare.halves.empty())
    throw usage_error("a picture is compared with a reference B or with --halves D1 D2: give one of them");
  if (!compare.error_picture.empty() && output_format(compare.error_picture) == OutputFormat::unknown)
    throw unknown_format(compare.error_picture);
  if (!std::isfinite(compare.exposure.value_or(0)))
    throw usage_error("--exposure", "a finite number", fmt::format("{}", *compare.exposure));
  if (!options.fail_above.empty()) compare.fail_above = share_of(options.fail_above);
  compare.log.format = options.json ? LogFormat::json : LogFormat::text;
  return compare;
}

constexpr double kReferenceError = .02, kQuickReferenceError = .03;

BenchArguments checked(BenchArguments bench, const Options& options) {
  if (!bench.halves.empty() && bench.scenes.size() > 1)
    throw usage_error("--halves are the reference of one scene", "a single scene",
                      std::to_string(bench.scenes.size()));
  if (!bench.halves.empty() && !(options.reference_error.empty() && bench.reference_dir.empty()))
    throw usage_error(
        "with --halves no reference is rendered: leave --reference-error and --reference-dir out");
  if (bench.csv.empty() && bench.report.empty() && bench.against.empty())
    throw usage_error("nothing is asked for", "-o FOLDER, --csv FILE or --against FILE");
  bench.reference_error = options.reference_error.empty()
                              ? (bench.quick ? kQuickReferenceError : kReferenceError)
                              : *share_of(options.reference_error);
  for (const std::string& text : options.rungs) {
    const std::size_t equals = text.find('=');
    bench.rungs.push_back({"hierarchical", "", text.substr(0, equals), text.substr(equals + 1)});
  }
  bench.overrides = overrides_of(options);
  return bench;
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
  constexpr std::array<std::string_view, 6> commands{"render", "info",  "compare",
                                                     "bench",  "cache", "precompute"};
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
  CompareArguments compare;
  PrecomputeArguments precompute;
  BenchArguments bench;
  CacheArguments cache;
  Options options;
  CLI::App app("opaline renders translucent things fast, and says how accurate the picture is.", "opaline");
  app.get_formatter()->column_width(34);
  app.set_version_flag("--version", "opaline " OPALINE_VERSION, "print the version");
  app.set_help_flag("-h,--help", "print this help");
  app.require_subcommand(0, 1);  // none at all is answered below: CLI11 would hide a misspelt one behind it
  app.footer(kExamples);
  CLI::App& render_command = *app.add_subcommand("render", "render a scene to EXR and PNG files");
  CLI::App& precompute_command =
      *app.add_subcommand("precompute", "fill a cache with what rendering will ask for");
  CLI::App& info_command =
      *app.add_subcommand("info", "print what a scene requires and why; nothing is rendered");
  CLI::App& compare_command = *app.add_subcommand("compare", "print how far a picture is from a reference");
  CLI::App& bench_command =
      *app.add_subcommand("bench", "measure what scenes cost and how far off they are, at many settings");
  CLI::App& cache_command = *app.add_subcommand("cache", "look after a folder of stage results (--cache)");
  add_render_options(render_command, render, options);
  add_precompute_options(precompute_command, precompute, options);
  add_common_options(info_command, info.scene, options);
  add_picture_options(info_command, options);
  add_compare_options(compare_command, compare, options);
  add_bench_options(bench_command, bench, options);
  add_cache_commands(cache_command, cache, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& failure) {
    if (failure.get_exit_code() == 0) return shown_text(app, failure);
    throw parse_error(app, failure);
  }
  if (app.get_subcommands().empty())
    throw usage_error("no command given: render, info, compare, bench, cache or precompute" + hint(app));
  if (compare_command.parsed()) return checked(std::move(compare), options);
  if (cache_command.parsed()) {
    cache.log.format = options.json ? LogFormat::json : LogFormat::text;
    return cache;
  }
  if (bench_command.parsed()) {
    for (int i = 1; i < argc; ++i) bench.command_line += ' ' + shell_quoted(argv[i]);
    return checked(std::move(bench), options);
  }
  const LogFormat format = options.log == "json" ? LogFormat::json : LogFormat::text;
  info.log.format = render.log.format = format;
  precompute.log.format = format;
  info.overrides = render.overrides = precompute.overrides = overrides_of(options);
  if (!options.frames.empty()) render.frames = precompute.frames = *parse_frames(options.frames);
  if (precompute_command.parsed()) return precompute;
  if (info_command.parsed()) return info;
  check_outputs(render);
  return render;
}

}  // namespace opaline
