// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the commands that render nothing of their own: import, compare, bench, profile and cache.
#include "cli/command_options.h"
#include "cli/help_texts.h"
#include "cli/option_helpers.h"
#include "cli/option_values.h"

namespace opaline {

void add_import_options(CLI::App& app, ImportArguments& import) {
  app.add_option("ASSET", import.asset, "GLB, glTF 2.0 or OBJ file")->required()->type_name("FILE");
  app.add_option("-o,--output", import.scene, "scene file to write, .json")->required()->type_name("FILE");
  app.add_option("--material", import.material,
                 "MaterialX file (.mtlx) in place of the asset's materials; one of several surfaces in it by "
                 "its name")
      ->type_name("FILE[#NAME]");
  add_allow_outside(app);
  app.add_flag("--overwrite", import.overwrite, "write over a scene file that says something else");
  app.add_flag("--quiet", import.log.quiet, "print what is not carried over, and errors only");
  app.footer(kImportNotes);
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
      ->check(number_check())
      ->type_name("STOPS");
  app.add_flag("--json", options.json, "the result as one JSON object on stdout");
  app.footer(kCompareNotes);
}

void add_bench_options(CLI::App& app, BenchArguments& bench, Options& options) {
  app.add_option("SCENE", bench.scenes, "scene files (JSON with comments), or assets")
      ->required()
      ->type_name("FILE");
  add_allow_outside(app);
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
  app.add_flag("--profiles", bench.profiles,
               "each translucent scene with each radial profile (dipole, normalized_diffusion), which has a "
               "reference of its own");
  app.add_flag(
      "--truth", bench.truth,
      "each translucent scene against random walks, too: the scene as it is, each radial profile, and "
      "volume_diffusion");
  app.add_flag("--quick", bench.quick, "to try it: few rungs, 128 pixels wide");
  app.footer(kBenchNotes);
}

void add_profile_options(CLI::App& app, ProfileArguments& profile, Options& options) {
  app.add_option("MEDIUM", profile.medium,
                 "a preset such as marble, or coefficients as a scene gives them: '{\"sigma_a\": 0.01, "
                 "\"sigma_s\": 20, \"g\": 0.9, \"specular_ior\": 1.33}'")
      ->required();
  app.add_option("--thickness", profile.thickness, "a slab, e.g. 2mm, 500um or .5cm; default: a half space")
      ->transform(millimetres_of())
      ->type_name("LENGTH");
  app.add_option("--eta", profile.eta, "index of refraction, inside over outside, in place of the medium's")
      ->check(number_check())
      ->type_name("X");
  app.add_option(
         "--g", profile.g,
         "mean cosine that walks scatter with, at the same reduced scattering (default: the medium's, or 0)")
      ->check(number_check())
      ->type_name("X");
  app.add_option(
         "--walks", profile.walks,
         "of each channel, for diffuse light and again for a beam along the normal; default: as many as "
         "ten seconds of CPU allow for all, up to 1000000")
      ->transform(whole_number(kWalks))
      ->type_name("N");
  app.add_option("--seed", profile.seed, "of the walks (default 1)")
      ->transform(whole_number(kMostWholeNumber))
      ->type_name("N");
  app.add_option("-o,--output", profile.report, "write a page with charts, and tables, into this folder")
      ->type_name("FOLDER");
  add_threads(app, profile.threads, "at most this many; default: one for each core");
  app.add_flag("--json", options.json, "the totals as one JSON object on stdout");
  app.footer(kProfileNotes);
}

void add_cache_commands(CLI::App& app, CacheArguments& cache, Options& options) {
  const auto add = [&](const char* name, CacheAction action, const char* help) {
    CLI::App& command = *app.add_subcommand(name, help);
    command.add_option("FOLDER", cache.folder, "what --cache named")->required()->type_name("FOLDER");
    command.add_flag("--json", options.json, "the result as one JSON object on stdout");
    command.parse_complete_callback([&cache, action] { cache.action = action; });
    command.footer(kCacheNotes);
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
