// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_options.h"

#include <fmt/format.h>

#include "cli/frames.h"
#include "cli/help_texts.h"
#include "cli/option_values.h"

namespace opaline {
namespace {

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

void add_threads(CLI::App& app, int& threads, const std::string& help) {
  app.add_option("--threads", threads, help)->transform(whole_number(kThreads))->type_name("N");
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

}  // namespace

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
      ->check(resolution_check())
      ->type_name("WxH")
      ->group(group);
  app.add_option("--crop", options.crop, "only these pixels, from the top left; x1 and y1 excluded")
      ->check(crop_check())
      ->type_name("x0,y0,x1,y1")
      ->group(group);
  app.add_option("--exposure", options.exposure, "stops, PNG only")->type_name("STOPS")->group(group);
  app.add_option(
         "--method", options.method,
         "hierarchical: light under the surface; lambert: plain paint, fast; direct: the reference, slow")
      ->type_name("NAME")
      ->group(group);
  app.add_option(
         "--evaluator", options.evaluator,
         "dual_tree: to settings.tolerance; surface_cache: the same, interpolated; classic: as published; "
         "brute_force: the exact sum, slow; default: automatic, one of the first two")
      ->type_name("NAME")
      ->group(group);
  app.add_option("--entry-samples", options.entry_samples, "direct: places of entry for each pixel")
      ->transform(whole_number(kEntrySamples))
      ->type_name("N")
      ->group(group);
  app.add_option("--until-error", options.until_error, "direct: stop at this noise of the pixels, e.g. 0.5%")
      ->check(positive_share_check())
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
  add_threads(app, render.threads, "at most this many; default: one for each core");
  app.add_flag("--quiet", render.log.quiet, "print warnings and errors only");
  app.add_flag("--timings-in-metadata", render.timings_in_metadata,
               "store the time of each stage in the EXR; its bytes then differ between runs");
  add_picture_options(app, options);
  const char* quality = "Quality";
  app.add_option("--target-error", options.target_error,
                 "choose samples, tolerance and evaluator for this error at the least cost, e.g. 1%")
      ->check(positive_share_check())
      ->type_name("PERCENT")
      ->group(quality);
  app.add_flag("--verify", render.verify, "measure the error at some 200 points by --method direct")
      ->group(quality);
  app.footer(kRenderNotes);
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
      ->check(share_check())
      ->type_name("SHARE");
  app.add_option("--error-picture", compare.error_picture, "write where the errors are, .png or .exr")
      ->type_name("FILE");
  app.add_option("--exposure", compare.exposure,
                 "stops, for FLIP; default: 0 for PNG, else what turns the p99 of B white")
      ->type_name("STOPS");
  app.add_flag("--json", options.json, "the result as one JSON object on stdout");
  app.footer(kCompareNotes);
}

void add_bench_options(CLI::App& app, BenchArguments& bench, Options& options) {
  app.add_option("SCENE", bench.scenes, "scene files (JSON with comments)")->required()->type_name("FILE");
  app.add_option("-o,--output", bench.report, "write a report into this folder")->type_name("FOLDER");
  app.add_option("--csv", bench.csv, "write all figures")->type_name("FILE");
  app.add_option("--against", bench.against,
                 "results.json of an earlier report: exit 1 if something got worse")
      ->type_name("FILE");
  app.add_option("--resolution", options.resolution, "width and height of all pictures, e.g. 256x256")
      ->check(resolution_check())
      ->type_name("WxH");
  add_repeatable(app, "--set", options.sets, "change any value of the scenes; repeatable")
      ->type_name("KEY=VALUE");
  add_repeatable(app, "--rung", options.rungs,
                 "one more hierarchical rung, with this one of the scene's settings; repeatable")
      ->check(rung_check())
      ->type_name("NAME=VALUE");
  app.add_option("--repeats", bench.repeats, "runs of each rung, at least 3 (default 3)")
      ->transform(whole_number(kRepeats))
      ->type_name("N");
  add_threads(app, bench.threads, "of each run (default 1)");
  app.add_option("--halves", bench.halves, "two references with independent noise, of a single scene")
      ->expected(2)
      ->type_name("FILE");
  app.add_option("--reference-error", options.reference_error,
                 "noise of each half that the bench renders (default 2%, 3% with --quick)")
      ->check(positive_share_check())
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
  add_threads(app, precompute.threads, "at most this many; default: one for each core");
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

}  // namespace opaline
