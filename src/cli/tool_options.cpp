// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the commands without a render of their own: import, compare, bench, profile and cache.
#include "cli/command_options.h"
#include "cli/help_texts.h"
#include "cli/option_helpers.h"
#include "cli/option_values.h"

namespace opaline {

void add_import_options(CLI::App& app, ImportArguments& import, Options& options) {
  app.add_option("ASSET", import.asset, "GLB, glTF 2.0, OBJ, PLY, STL or OFF file")
      ->required()
      ->type_name("FILE");
  app.add_option("-o,--output", import.scene, "scene file to write, .json")->required()->type_name("FILE");
  app.add_option(
         "--material", import.material,
         "MaterialX file (.mtlx): its materials replace those of the same names; with NAME, this surface or "
         "material replaces all")
      ->type_name("FILE[#NAME]");
  app.add_option("--animation", import.animation,
                 "animation of a glTF file that moves the scene, by its name or number (default: the first)")
      ->type_name("NAME");
  add_asset_options(app, options);
  add_allow_outside(app);
  app.add_flag("--overwrite", import.overwrite, "replace an existing scene file with different content");
  app.add_flag("--quiet", import.log.quiet, "print errors and the parts that are not imported only");
  app.footer(kImportNotes);
}

void add_compare_options(CLI::App& app, CompareArguments& compare, Options& options) {
  app.add_option("A", compare.picture, "image under test, EXR or PNG")->required()->type_name("FILE");
  app.add_option("B", compare.reference, "reference, EXR or PNG")->type_name("FILE");
  app.add_option("--halves", compare.halves, "two references with independent noise, in place of B")
      ->expected(2)
      ->type_name("FILE");
  app.add_option("--layer", compare.layer, "layer of the EXR, e.g. diffuse (default: R, G, B)")
      ->type_name("NAME");
  app.add_option("--fail-above", options.fail_above,
                 "exit with 1 if the mean relative error of a channel exceeds this value, e.g. 1% or 0.01")
      ->check(share_check())
      ->type_name("SHARE");
  app.add_option("--error-picture", compare.error_picture, "error image to write, .png or .exr")
      ->type_name("FILE");
  app.add_option("--exposure", compare.exposure,
                 "exposure for FLIP, in stops (default: 0 for PNG; otherwise maps the p99 of B to white)")
      ->check(number_check())
      ->type_name("STOPS");
  app.add_flag("--json", options.json, "print the result as one JSON object on stdout");
  app.footer(kCompareNotes);
}

void add_bench_options(CLI::App& app, BenchArguments& bench, Options& options) {
  app.add_option("SCENE", bench.scenes, "scene files (JSON with comments) or assets")
      ->required()
      ->type_name("FILE");
  add_allow_outside(app);
  app.add_option("-o,--output", bench.report, "folder of the report")->type_name("FOLDER");
  app.add_option("--csv", bench.csv, "CSV file of all results")->type_name("FILE");
  app.add_option("--against", bench.against,
                 "results.json of an earlier report; exit with 1 if a result is worse")
      ->type_name("FILE");
  app.add_option("--resolution", options.resolution, "width and height of all images, e.g. 256x256")
      ->check(resolution_check())
      ->type_name("WxH");
  add_repeatable(app, "--set", options.sets, "override a value of the scenes; repeatable")
      ->type_name("KEY=VALUE");
  add_repeatable(app, "--rung", options.rungs, "additional run of hierarchical with this setting; repeatable")
      ->check(rung_check())
      ->type_name("NAME=VALUE");
  app.add_option("--repeats", bench.repeats, "repeats of each run, at least 3 (default 3)")
      ->transform(whole_number(kRepeats))
      ->type_name("N");
  add_threads(app, bench.threads, "threads of each run (default 1)");
  app.add_option("--halves", bench.halves, "two references with independent noise, for a single scene")
      ->expected(2)
      ->type_name("FILE");
  app.add_option("--reference-error", options.reference_error,
                 "noise of each rendered half (default 2%, 3% with --quick)")
      ->check(positive_share_check())
      ->type_name("SHARE");
  app.add_option("--reference-dir", bench.reference_dir,
                 "folder of the halves (default: references, in the report's or the CSV's folder)")
      ->type_name("FOLDER");
  app.add_flag("--profiles", bench.profiles,
               "measure each translucent scene with each radial profile (dipole, normalized_diffusion), each "
               "against its own reference");
  app.add_flag("--truth", bench.truth,
               "also measure each translucent scene against random walks: as given, with each radial "
               "profile, and with volume_diffusion");
  app.add_flag("--quick", bench.quick, "quick trial: few settings, images 128 pixels wide");
  app.footer(kBenchNotes);
}

void add_profile_options(CLI::App& app, ProfileArguments& profile, Options& options) {
  GivenProfile& given = profile.given;
  app.add_option("MEDIUM", given.medium,
                 "a preset such as marble, or the coefficients as in a scene file: '{\"sigma_a\": 0.01, "
                 "\"sigma_s\": 20, \"g\": 0.9, \"specular_ior\": 1.33}'")
      ->required();
  app.add_option("--scene", given.scene, "read the medium of this name from a scene file")->type_name("FILE");
  app.add_option("--thickness", given.thickness,
                 "thickness of a slab, e.g. 2mm, 500um or 0.5cm (default: a half space)")
      ->transform(millimetres_of())
      ->type_name("LENGTH");
  app.add_option("--eta", given.eta, "index of refraction, inside over outside (default: the medium's)")
      ->check(number_check())
      ->type_name("X");
  app.add_option(
         "--g", given.g,
         "mean cosine of the scattering angle, at the same reduced scattering (default: the medium's, or 0)")
      ->check(number_check())
      ->type_name("X");
  app.add_option("--walks", given.walks,
                 "random walks per channel, for each of diffuse light and a beam along the normal (default: "
                 "as many as ten seconds of CPU allow in total, at most 1,000,000)")
      ->transform(whole_number(kWalks))
      ->type_name("N");
  app.add_option("--seed", given.seed, "random seed (default 1)")
      ->transform(whole_number(kMostWholeNumber))
      ->type_name("N");
  app.add_option("-o,--output", profile.report, "folder of a page with charts and tables")
      ->type_name("FOLDER");
  add_threads(app, profile.threads, "maximum number of threads (default: one per core)");
  app.add_flag("--json", options.json, "print the totals as one JSON object on stdout");
  app.footer(kProfileNotes);
}

void add_cache_commands(CLI::App& app, CacheArguments& cache, Options& options) {
  const auto add = [&](const char* name, CacheAction action, const char* help) {
    CLI::App& command = *app.add_subcommand(name, help);
    command.add_option("FOLDER", cache.folder, "folder of the cache")->required()->type_name("FOLDER");
    command.add_flag("--json", options.json, "print the result as one JSON object on stdout");
    command.parse_complete_callback([&cache, action] { cache.action = action; });
    command.footer(kCacheNotes);
    return &command;
  };
  add("ls", CacheAction::list, "list the entries, least recently used first");
  add("verify", CacheAction::verify, "read every entry completely; exit with 1 if one is damaged");
  CLI::App& prune = *add("prune", CacheAction::prune, "remove the least recently used entries");
  add_size(prune, "--size", cache.most_bytes, "size that remains, e.g. 500MB (default 8GB)");
  app.require_subcommand(1);
  app.footer(kCacheNotes);
}

}  // namespace opaline
