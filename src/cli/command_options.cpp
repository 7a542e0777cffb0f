// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_options.h"

#include <fmt/format.h>

#include "cli/frames.h"
#include "cli/help_texts.h"
#include "cli/option_helpers.h"
#include "cli/option_values.h"

namespace opaline {
namespace {

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
  app.add_option("--layers", options.layers,
                 "what the EXR holds beside R, G, B and A: diffuse (default), specular, albedo, N, P, Z, "
                 "irradiance, error, direct's variance; all or none")
      ->check(layers_check())
      ->type_name("NAME,...");
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
  app.add_flag("--write-partial", render.write_partial,
               "write coarse pictures to the outputs, the first within a tenth of the time, and what is done "
               "every five seconds; an interrupted run leaves the last one");
  app.add_option("--display-server", options.display_server,
                 "show the same in the viewer tev, tile by tile (default port 14158)")
      ->check(server_address_check())
      ->type_name("HOST:PORT");
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
  app.add_option("--time-budget", options.time_budget,
                 "choose them for the smallest error within this CPU time of all, e.g. 2s; direct: stop then")
      ->transform(seconds_of())
      ->check(CLI::PositiveNumber.description(""))
      ->type_name("TIME")
      ->group(quality);
  app.add_flag("--verify", render.verify, "measure the error at some 200 points by --method direct")
      ->group(quality);
  app.footer(kRenderNotes);
}

void add_precompute_options(CLI::App& app, PrecomputeArguments& precompute, Options& options) {
  add_common_options(app, precompute.scene, options);
  app.add_option("--cache", precompute.cache, "the folder to fill")->required()->type_name("FOLDER");
  add_size(app, "--cache-size", precompute.cache_bytes, "the least recently used beyond it go (default 8GB)");
  add_frames_option(app, options);
  add_threads(app, precompute.threads, "at most this many; default: one for each core");
  app.add_flag("--quiet", precompute.log.quiet, "print warnings and errors only");
}

}  // namespace opaline
