// SPDX-License-Identifier: GPL-3.0-or-later
// The command line: what it offers, and how it answers a mistake.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "run_program.h"

namespace opaline {
namespace {

// Claim: help and version are asked for, so they are no failure; help shows commands to copy.
// Source: arguments.h. Fails if: CLI11's exception for --help is taken for an error.
TEST(CliArguments, HelpAndVersion) {
  for (const std::vector<std::string>& line :
       std::vector<std::vector<std::string>>{{"--help"},
                                             {"render", "--help"},
                                             {"info", "-h"},
                                             {"--version"},
                                             {"help"},
                                             {"help", "cache", "ls"}}) {
    const Outcome outcome = run_program(line);
    EXPECT_EQ(outcome.exit_code, 0) << line[0];
    EXPECT_TRUE(outcome.err.empty()) << outcome.err;
    EXPECT_FALSE(outcome.out.empty());
  }
  EXPECT_EQ(run_program({"help", "render"}).out, run_program({"render", "--help"}).out);
  EXPECT_TRUE(contains(run_program({"--help"}).out, "opaline render bunny.json -o bunny.exr"));
  EXPECT_TRUE(run_program({"--version"}).out.starts_with("opaline "));
}

// Claim: a mistake on the command line is exit 2, one line on stderr that names it, nothing on stdout, no
// file. Source: the design exit codes. Fails if: CLI11's own codes (above 100) come through, or a check is
// left out, or a scene's message comes through where the option could have been named.
TEST(CliArguments, MistakesAreAnsweredInOneLine) {
  const SceneFolder folder;
  const std::string& scene = folder.scene;
  const std::string out = folder.file("out.exr");
  std::filesystem::create_directory_symlink(folder.path, folder.file("link"));
  EXPECT_EQ(run_program({"help", "help"}).out, run_program({"--help"}).out);
  const struct {
    std::vector<std::string> arguments;
    std::string named;
  } cases[] = {
      {{}, "no command"},
      {{"rendr", scene}, "unknown command 'rendr' (did you mean 'render'?)"},
      {{"ifno", scene, "--spp", "4"}, "unknown command 'ifno' (did you mean 'info'?)"},
      {{"draw", scene},
       "unknown command 'draw' (expected one of render, turntable, merge, view, precompute, info, import, "
       "compare, bench, "
       "profile, "
       "cache, schema)"},
      {{"cache", "lss", out}, "unknown command 'lss' (did you mean 'ls'?)"},
      {{"render", scene, "-o", out, "--spp", "4", "--spp", "8"}, "--spp: given more than once"},
      {{"-v"}, "unknown option '-v' (did you mean '--version'?)"},
      {{"info", scene, "--set", "lights.0={\"type\": \"rect\"}"}, "(did you mean 'quad'?)"},
      {{"help", "rendr"}, "unknown command 'rendr' (did you mean 'render'?)"},
      {{"render", scene, "--outpt", out}, "unknown option '--outpt' (did you mean '--output'?)"},
      {{"render", scene, "-o", out, "--spps=4"}, "unknown option '--spps' (did you mean '--spp'?)"},
      {{"cache", "ls", out, "--jsn"}, "(did you mean '--json'?); see opaline cache ls --help"},
      {{"info", scene, "more"}, "unexpected argument 'more'"},
      {{"info", scene, "--set", "spp=4"},
       "unknown key 'spp' in the scene (did you mean 'film.samples_per_pixel'?)"},
      {{"info", scene, "--set", "samples=4"},
       "unknown key 'samples' in the scene (did you mean 'film.samples_per_pixel' or 'settings.samples'?)"},
      {{"info", scene, "--set", "roughness=.3"}, "(did you mean 'media.NAME.specular_roughness'?)"},
      {{"info", scene, "--set", "media.marble.color=.3"},
       "unknown key 'color' in 'media.marble' (did you mean 'subsurface_color' or 'base_color'?)"},
      {{"info", scene, "--samples", "100"},
       "unknown option '--samples' (did you mean '--spp N' or '--set settings.samples=N'?)"},
      {{"render", scene, "-o", out, "--width=64"}, "(did you mean '--resolution WxH'?)"},
      {{"render", scene, "-o", out, "--cores", "2"}, "unknown option '--cores' (did you mean '--threads'?)"},
      {{"render", scene, "-o", out, "--quality", "9"}, "(did you mean '--target-error' or '--spp'?)"},
      {{"render", scene, "-o", out, "--noise"}, "(did you mean '--denoise' or '--until-error'?)"},
      {{"render", scene, "-o", out, "--verbose"}, "unknown option '--verbose' (did you mean '--log'?)"},
      {{"view", scene, "--fov", "30"}, "(did you mean '--set camera.field_of_view=N'?)"},
      {{"precompute", scene, "--cache", out, "--spp", "3"}, "'--set film.samples_per_pixel=N'"},
      {{"info", scene, "--set", "resolutoin=[4,4]"}, "(did you mean 'film.resolution'?)"},
      {{"info", scene, "--set", "settings.sampels=4"}, "(did you mean 'samples'?)"},
      {{"info", "bunny.ply"}, "bunny.ply: no such mesh file"},
      {{"info", "bunny.png"}, "bunny.png: is an image, not a scene"},
      {{"render", scene, "-o", out, "--target-error", "1"}, "got 1, which is 100 %; did you mean 1%?"},
      {{"render", scene, "-o", out, "--until-error", "2"}, "did you mean 2%?"},
      {{scene}, "unknown command '"},
      {{"--quiet", "rendr"}, "--quiet"},
      {{"render"}, "required"},
      {{"render", scene}, "--output"},
      {{"render", "-o", out}, "SCENE"},
      {{"render", scene, "-o", out, "--sppp", "4"}, "--sppp"},
      {{"render", scene, "-o", out, "--spp", "many"}, "many"},
      {{"render", scene, "-o", out, "--spp", "2.5"}, "2.5"},
      {{"render", scene, "-o", out, "--spp", "0"}, "--spp: expected a whole number from 1 to 65536, got 0"},
      {{"info", scene, "--spp", "-3"}, "--spp: expected a whole number from 1 to 65536, got -3"},
      {{"info", scene, "--spp", "65537"}, "--spp: expected a whole number from 1 to 65536, got 65537"},
      {{"render", scene, "-o", out, "--seed", "-3"},
       "--seed: expected a whole number from 0 to 18446744073709551615, got -3"},
      {{"info", scene, "--seed", "18446744073709551616"},
       "--seed: expected a whole number from 0 to 18446744073709551615, got 18446744073709551616"},
      {{"info", scene, "--seed", "0x10"}, "got 0x10"},
      {{"render", scene, "-o", out, "--threads", "0"},
       "--threads: expected a whole number from 1 to 4096, got 0"},
      {{"render", scene, "-o", out, "--threads", "4097"},
       "--threads: expected a whole number from 1 to 4096, got 4097"},
      {{"render", scene, "-o", out, "--resolution", "64"}, "WIDTHxHEIGHT"},
      {{"render", scene, "-o", out, "--resolution", "64x48x3"}, "WIDTHxHEIGHT"},
      {{"render", scene, "-o", out, "--resolution", "64,48"}, "WIDTHxHEIGHT"},
      {{"info", scene, "--resolution", "64x-48"}, "--resolution: expected WIDTHxHEIGHT"},
      {{"info", scene, "--resolution", "0x48"}, "--resolution: expected WIDTHxHEIGHT, each 1 to 65536"},
      {{"info", scene, "--resolution", "65537x48"}, "got 65537x48"},
      {{"render", scene, "-o", out, "--crop", "0,0,16"}, "x0,y0,x1,y1"},
      {{"info", scene, "--crop", "-1,0,16,16"}, "--crop: expected four numbers x0,y0,x1,y1"},
      {{"render", scene, "-o", out, "--exposure", "bright"}, "--exposure: expected a number, got bright"},
      {{"render", scene, "-o", out, "--samples-ply", folder.file("s.txt")}, "a name that ends in .ply"},
      {{"render", scene, "-o", out, "--log", "xml"}, "--log: expected text or json, got xml"},
      {{"render", scene, "-o", out, "--time-budget", "0s"}, "--time-budget: expected a time such as 2s"},
      {{"render", scene, "-o", out, "--time-budget", "-1s"}, "got -1s"},
      {{"render", scene, "-o", out, "--time-budget", "2m"}, "got 2m"},
      {{"render", scene, "-o", out, "--time-budget", "fast"}, "got fast"},
      {{"render", scene, "-o", out, "--cache", out, "--cache-size", "-1"}, "such as 500MB or 8GB, got -1"},
      {{"render", scene, "-o", out, "--cache", out, "--cache-size", "20XB"},
       "such as 500MB or 8GB, got 20XB"},
      {{"render", scene, "-o", out, "--cache-size", "2GB"}, "--cache-size requires --cache"},
      {{"cache", "prune", out, "--size", "-5GB"}, "such as 500MB or 8GB, got -5GB"},
      {{"cache", "prune", out, "--size", "5"}, "such as 500MB or 8GB, got 5"},
      {{"cache"}, "no command given: ls, verify, prune; see opaline cache --help"},
      {{"profile", "marble", "--thickness", "2in"}, "--thickness: expected a length such as 2mm"},
      {{"profile", "marble", "--g", "x"}, "--g: expected a number, got x"},
      {{"render", scene, "-o", out, "--res", "3x3"}, "(did you mean '--resolution' or '--resume'?)"},
      {{"view", scene, "-o", out},
       "unknown option '-o' (an option of opaline render, turntable, merge, import, bench, profile); see "
       "opaline "
       "view --help"},
      {{"info", scene, "--target-error", "5%"},
       "'--target-error' (an option of opaline render, turntable); see"},
      {{"render", scene, "-o", out, "--fail-above=1%"}, "'--fail-above' (an option of opaline compare); see"},
      {{"compare", out, out, "--spp", "4"},
       "'--spp' (an option of opaline render, turntable, view, info); see"},
      {{"info", scene, "--target-eror", "5%"},
       "'--target-eror' (did you mean '--target-error'?), an option of opaline render; see opaline info "
       "--help"},
      {{"cache", "ls", out, "--fail-abov=1%"},
       "(did you mean '--fail-above'?), an option of opaline compare; see"},
      {{"info", scene, "--cache-siz", "5GB"},
       "(did you mean '--cache-size'?), an option of opaline render; see"},
      {{"render", scene, "-o", out, "--reindex"}, "unknown option '--reindex'; see"},
      {{"render", scene, "-o", out, "--preset", "marble"},
       "unknown option '--preset' (did you mean '--set media.NAME.preset=VALUE'?)"},
      {{"info", scene, "--medium=basalt"},
       "is not a medium of this scene (expected one of marble, or with --medium a preset: apple, "},
      {{"info", scene, "--size", "5GB"}, "a length such as 2mm"},
      {{"view", scene, "--ior", "1.4"},
       "(did you mean '--set media.NAME.specular_ior=N' or '--set shapes.NAME.specular_ior=N'?)"},
      {{"info", scene, "--near-field", "false"}, "'--set settings.laboratory.near_field=VALUE'"},
      {{"info", scene, "--set", "camera.position=0,0,90"},
       "'camera.position' has the wrong type (did you mean [0,0,90]?)"},
      {{"info", scene, "--set", "camera.look_at=(0, -1 90)"}, "(did you mean [0,-1,90]?)"},
      {{"info", scene, "--set", "film.resolution=640x480"}, "(did you mean [640,480]?)"},
      {{"info", scene, "--set", "media.marble.tint=1,0.5,0"}, "(did you mean [1,0.5,0]?)"},
      {{"info", scene, "--set", "camera.position=a,b"},
       "'camera.position' has the wrong type (expected a list"},
      {{"render", scene, "-o", out, "--frames", "5-1"}, "--frames: a range ends before it begins"},
      {{"render", scene, "-o", out, "--frames", "1-1000000000"}, "at most 100,000, got 1-1000000000"},
      {{"render", scene, "-o", folder.file("a.#.exr"), "--frames", "1-4"},
       "a single # is not a frame number placeholder"},
      {{"render", scene, "-o", folder.file("out.jpg")}, "out.jpg"},
      {{"render", scene, "-o", folder.file("exr")}, ".exr or .png"},
      {{"render", scene, "-o", out, "-o", out}, "same name"},
      {{"render", scene, "-o", out, "--method", "direct", "--resume", out}, "same name"},
      {{"render", scene, "-o", out, "--method", "direct", "--resume", folder.file("./out.exr")}, "same name"},
      {{"render", scene, "-o", out, "--method", "direct", "--resume", folder.file("link/out.exr")},
       "same name"},
      {{"info", scene, "-o", out}, "-o"},
      {{"render", scene, "-o", out, "--method", "lambrt"},
       "error: --method: 'settings.method' does not allow"},
      {{"render", scene, "-o", out, "--method", "lambrt"}, "did you mean 'lambert'"},
      {{"render", scene, "-o", out, "--set", "settings.method=lambrt"},
       "error: --set settings.method=lambrt"},
      {{"render", scene, "-o", out, "--view", "agxx"}, "error: --view: 'film.view' does not allow 'agxx'"},
      {{"render", scene, "-o", out, "--crop", "0,0,64,64"}, "error: --crop: 'film.crop.2' is out of range"},
      {{"render", scene + "n", "-o", out}, "no such scene file (did you mean '" + scene + "'?)"},
      {{"render", scene, "-o", out, "--until-error", "1%", "--time-budget", "9s"},
       "one of --time-budget and --until-error"},
      {{"render", scene, "-o", out, "--entry-samples", "64"}, "(expected --method direct, got hierarchical)"},
      {{"render", scene, "-o", folder.file("a.png"), "--layers", "P"}, "--layers requires an EXR output"},
      {{"render", scene, "-o", folder.file("a.##.exr")}, "--frames FIRST-LAST, or a name without ##"},
      {{"render", scene, "-o", out, "--resolution", "1000000000x1000000000"}, "resolution"},
      {{"render", scene, "-o", out, "--set", "media.marbel.eta=1.4"}, "did you mean 'marble'"},
      {{"render", scene, "-o", out, "--set", "film.crop=[0,0,32,32]", "--resolution", "16x16"}, "crop"},
      {{"render", scene, "-o", out, "--method", "lambert", "--samples-ply", folder.file("s.ply")},
       "no samples"},
      {{"compare"}, "required"},
      {{"compare", out}, "--halves"},
      {{"compare", out, out, "--halves", out, out}, "either a reference"},
      {{"compare", out, "--halves", out}, "--halves"},
      {{"compare", out, out, out}, "out.exr"},
      {{"compare", out, out, "--fail-above", "1e"}, "1% or 0.01"},
      {{"compare", out, out, "--fail-above", "-1%"}, "1% or 0.01"},
      {{"compare", out, out, "--fail-above", "2"}, "got 2, which is 200 %; did you mean 2%?"},
      {{"compare", out, out, "--fail-above", "nan"}, "1% or 0.01"},
      {{"compare", out, out, "--fail-above", "%"}, "1% or 0.01"},
      {{"compare", out, out, "--exposure", "nan"}, "nan"},
      {{"compare", out, out, "--error-picture", "error.jpg"}, "error.jpg"},
      {{"compare", out, out}, "no such image file"},
  };
  for (const auto& c : cases) {
    std::vector<std::string> arguments = c.arguments;
    if (!arguments.empty() && arguments[0] == "render") arguments.push_back("--quiet");
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("opaline: error: ")) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, c.named)) << "no \"" << c.named << "\" in: " << outcome.err;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  }
  EXPECT_EQ(folder.entries(), 2u);  // the scene, and the link
}

// Claim: short options come before every --set, and the last --set wins; several outputs and options may
// stand around the scene. Source: arguments.h. Fails if: --set values are applied first, or -o takes all that
// follows.
TEST(CliArguments, OrderOfOverrides) {
  const SceneFolder folder;
  const auto plan = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"info", "--log", "json"});
    arguments.push_back(folder.scene);
    return event_of(events_of(run_program(arguments).out), "plan");
  };
  EXPECT_EQ(plan({"--spp", "4"})["samples_per_pixel"], 4);
  EXPECT_EQ(plan({"--set", "film.samples_per_pixel=3", "--spp", "4"})["samples_per_pixel"], 3);
  EXPECT_EQ(plan({"--set", "settings.samples=7", "--set", "settings.samples=9"})["groups"][0]["samples"], 9);
  EXPECT_EQ(plan({"--spp", "010"})["samples_per_pixel"], 10);
  const nlohmann::json all =
      plan({"--resolution", "8x6", "--crop", "1,2,3,4", "--method", "lambert", "--evaluator", "brute_force",
            "--exposure", "-1.5", "--seed", "18446744073709551615"});
  EXPECT_EQ(all["resolution"], (std::vector<int>{8, 6}));
  EXPECT_EQ(all["crop"], (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(all["method"], "lambert");
  EXPECT_EQ(all["evaluator"], "brute_force");
}

}  // namespace
}  // namespace opaline
