// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline render` with --target-error, --time-budget and --verify: what it says, and what it does not take.
#include <algorithm>

#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

/// A ball of 64 x 64 pixels without samples of its own.
struct QualityFolder : SceneFolder {
  QualityFolder() {
    std::string text = bytes_of(scene);
    const std::string own = R"("samples": 500)";
    text.replace(text.find(own), own.size(), R"("seed": 5)");
    text.replace(text.find("[32, 32]"), 8, "[64, 64]");
    put_bytes(scene, text);
  }
  Outcome render(const std::vector<std::string>& more, const std::string& out = "a.exr") const {
    std::vector<std::string> line{"render", scene, "-o", file(out)};
    line.insert(line.end(), more.begin(), more.end());
    return run_program(line);
  }
};

std::string metadata_of(const std::string& path, const std::string& key) {
  for (const auto& [name, value] : read_image(path).metadata)
    if (name == key) return value;
  return {};
}

// Claim: the closing line states the predicted and the measured error, the log and the picture's metadata the
// same figures, and the command in the metadata makes the picture again. Source: the design. Fails if:
// --verify measures nothing, or the target is not in the command.
TEST(CliQuality, StatesPredictedAndMeasured) {
  const QualityFolder folder;
  const Outcome text = folder.render({"--target-error", "6%", "--verify"});
  ASSERT_EQ(text.exit_code, 0) << text.err;
  const std::size_t at = text.out.find("\nerror "), settings = text.out.find("settings predicted ");
  ASSERT_TRUE(at < settings && settings != std::string::npos) << text.out;
  const std::string line = text.out.substr(settings, text.out.find('\n', settings) - settings);
  EXPECT_TRUE(contains(line, "predicted ") && contains(line, ", measured ") && contains(line, " +- "))
      << line;
  EXPECT_TRUE(contains(text.out, "target      6 %:")) << text.out;

  const Outcome json = folder.render({"--target-error", "0.06", "--verify", "--log", "json"}, "b.exr");
  const auto events = events_of(json.out);
  const nlohmann::json errors = event_of(events, "done")["errors"], target = event_of(events, "target");
  EXPECT_EQ(errors["target"], .06);
  EXPECT_LE(errors["measured"], .06) << errors;
  EXPECT_GT(errors["standard_error"], 0);
  EXPECT_EQ(errors["predicted"], target["predicted_error"]);
  EXPECT_TRUE(target["reached"]);
  EXPECT_EQ(nlohmann::json::parse(metadata_of(folder.file("b.exr"), "opaline:error")), errors);
  EXPECT_TRUE(contains(metadata_of(folder.file("a.exr"), "opaline:command"), "--target-error 0.06"));
  EXPECT_TRUE(bytes_of(folder.file("a.exr")) == bytes_of(folder.file("b.exr")));
}

// Claim: one thread or two, the same file. Fails if: the choice depends on time or on the order of threads.
TEST(CliQuality, SameBytesForAnyThreads) {
  const QualityFolder folder;
  for (const char* threads : {"1", "2"})
    ASSERT_EQ(
        folder
            .render({"--target-error", "1%", "--threads", threads, "--quiet"}, std::string(threads) + ".exr")
            .exit_code,
        0);
  EXPECT_TRUE(bytes_of(folder.file("1.exr")) == bytes_of(folder.file("2.exr")));
}

// Claim: a target out of reach is a warning that names the limit and the error that is predicted instead; the
// picture is made. A scene without anything translucent gets a warning that nothing is promised. Fails if:
// either is silent.
TEST(CliQuality, WarnsWhereNothingCanBePromised) {
  const QualityFolder folder;
  const Outcome outcome = folder.render({"--target-error", "0.01%", "--set", "settings.max_samples=3000"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(contains(outcome.err, "cannot reach an error of") &&
              contains(outcome.err, "max_samples of 3000"))
      << outcome.err;
  put_bytes(folder.scene, R"({"shapes": [{"name": "ball", "sphere": {"radius": 10}}],
    "lights": [{"type": "point", "position": [20, 30, 40], "intensity": 1000}],
    "camera": {"position": [0, 0, 50]}, "film": {"resolution": [32, 32]}})");
  const Outcome opaque = folder.render({"--target-error", "1%", "--verify"});
  EXPECT_EQ(opaque.exit_code, 0) << opaque.err;
  EXPECT_TRUE(contains(opaque.err, "--target-error has no effect")) << opaque.err;
  EXPECT_TRUE(contains(opaque.err, "--verify measures nothing")) << opaque.err;
}

/// The closing line of that label; empty if there is none.
std::string closing_line(const std::string& out, const std::string& label) {
  const std::size_t at = out.rfind("\n" + label + " ");
  return at == std::string::npos ? "" : out.substr(at + 1, out.find('\n', at + 1) - at - 1);
}

// Claim: --target-error and --time-budget replace `auto` by the method of all bodies, --verify by hierarchical; the command
// under "repeat with" names it. Source: quality.h. Fails if: settings are chosen for `auto`, which has none of its own, or the
// repeated image is by another method, a target without the error of the model is silent, or one body by hierarchical, or a thin
// one, takes the cells from all bodies.
TEST(CliQuality, AChoiceNamesTheMethodOfAuto) {
  const SceneFolder folder;
  const auto repeated = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"render", folder.scene, "-o", folder.file("a.exr"), "--method", "auto"});
    const Outcome outcome = run_program(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const bool has_model_error = !contains(outcome.err, "--target-error leaves out the error of the model");
    EXPECT_EQ(has_model_error, !contains(outcome.out, "settings.method=hierarchical")) << outcome.err;
    return outcome.out.substr(std::min(outcome.out.find("repeat with"), outcome.out.size()));
  };
  const std::string cells = repeated({"--target-error", "9%"});
  EXPECT_TRUE(contains(cells, "settings.method=volume_diffusion") && contains(cells, "settings.cell_size="))
      << cells;
  const std::string profile = repeated({"--target-error", "9%", "--set", "media.marble.profile=dipole"});
  EXPECT_TRUE(contains(profile, "settings.method=hierarchical")) << profile;
  const std::string thin = repeated({"--target-error", "9%", "--size", "0.5mm"});
  EXPECT_TRUE(contains(thin, "settings.method=volume_diffusion")) << thin;
  const std::string budget = repeated({"--time-budget", "1s"});
  EXPECT_TRUE(contains(budget, "settings.method=volume_diffusion") && contains(budget, "settings.cell_size="))
      << budget;
  std::string text = bytes_of(folder.scene);
  text.insert(text.find("}],"), R"(}, {"name": "other", "sphere": {"radius": 4}, "medium": "other")");
  text.insert(text.find("\"marble\": {"), R"("other": {"preset": "marble", "profile": "dipole"}, )");
  put_bytes(folder.scene, text);
  const std::string mixed = repeated({"--target-error", "9%"});
  EXPECT_TRUE(contains(mixed, "settings.method=auto") && contains(mixed, "settings.cell_size=")) << mixed;
}

// Claim: the closing lines state the predicted and the measured error, the CPU of the whole table against the
// budget, --verify not counted, and a command that makes the same pixels without a clock. Fails if: --verify
// is counted, the start of the program is not, or a chosen setting is left out of the command.
TEST(CliQuality, BudgetStatesWhatWasSpentAndHowToRepeatIt) {
  const QualityFolder folder;
  const Outcome json = folder.render(
      {"--time-budget", "3s", "--verify", "--log", "json", "--set", "settings.max_samples=300"});
  ASSERT_EQ(json.exit_code, 0) << json.err;
  const nlohmann::json done = event_of(events_of(json.out), "done"), budget = done["budget"];
  double verifying = 0;
  for (const nlohmann::json& stage : done["stages"])
    if (stage["stage"] == "verifying") verifying = stage["cpu_seconds"];
  EXPECT_GT(verifying, 0);
  EXPECT_EQ(done["stages"][0]["stage"], "start");
  EXPECT_EQ(budget["seconds"], 3);
  EXPECT_NEAR(double(budget["spent"]), double(done["cpu_seconds"]) - verifying, 1e-6);
  EXPECT_GT(done["errors"].value("predicted", 0.0), 0);
  EXPECT_GT(done["errors"].value("measured", 0.0), 0);

  const std::string command = metadata_of(folder.file("a.exr"), "opaline:command");
  ASSERT_TRUE(contains(command, "--set settings.samples=")) << command;
  std::vector<std::string> repeat;
  std::istringstream words(command.substr(command.find("--set")));
  for (std::string word; words >> word;) repeat.push_back(word);
  ASSERT_EQ(folder.render(repeat, "b.exr").exit_code, 0) << command;
  const Image a = read_image(folder.file("a.exr")), b = read_image(folder.file("b.exr"));
  EXPECT_TRUE(std::ranges::equal(a.pixels, b.pixels));
  EXPECT_EQ(metadata_of(folder.file("b.exr"), "opaline:command"), command);
  EXPECT_EQ(metadata_of(folder.file("b.exr"), "opaline:scene_hash"),
            metadata_of(folder.file("a.exr"), "opaline:scene_hash"));

  const Outcome text = folder.render({"--time-budget", "1.5"}, "c.exr");
  EXPECT_TRUE(contains(closing_line(text.out, "budget"), "s of CPU, ")) << text.out;
  EXPECT_TRUE(contains(closing_line(text.out, "repeat with"), "--set settings.tolerance=")) << text.out;
  EXPECT_TRUE(text.out.starts_with("budget      1.5 s: ")) << text.out;
  EXPECT_EQ(folder.entries(), 4u);  // nothing of the trials
}

// Claim: the command behind "repeat with" runs as it is printed, in the folder where the first one ran, whatever
// is in the names of scene and output: the same pixels, and but for a target the same bytes. Source: metadata.h.
// Fails if: the program's path, an output or a setting that was chosen is left out, or a blank is not quoted.
struct Choosing {
  std::string name;
  std::vector<std::string> options;
};

class CliAgainBy : public testing::TestWithParam<Choosing> {};

TEST_P(CliAgainBy, RunsAsPrinted) {
  const QualityFolder folder;
  const std::string output = "it's a $HOME.exr";
  std::filesystem::rename(folder.scene, folder.file("a ball.json"));
  std::vector<std::string> words{"render", "a ball.json", "-o", output, "--set", "lights.key.name=the key"};
  words.insert(words.end(), GetParam().options.begin(), GetParam().options.end());
  const Outcome first = run_program(words, folder.path.string());
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const std::string line = closing_line(first.out, "repeat with"), before = bytes_of(folder.file(output));
  const Image picture = read_image(folder.file(output));
  ASSERT_GT(line.size(), 12u) << first.out;
  std::filesystem::remove(folder.file(output));
  put_bytes(folder.file("again.sh"), line.substr(12) + " >/dev/null\n");
  ASSERT_EQ(std::system(("cd '" + folder.path.string() + "' && sh again.sh").c_str()), 0) << line;
  EXPECT_TRUE(read_image(folder.file(output)).pixels == picture.pixels);
  EXPECT_TRUE(bytes_of(folder.file(output)) == before || GetParam().name != "TimeBudget");
}

INSTANTIATE_TEST_SUITE_P(Options, CliAgainBy,
                         testing::Values(Choosing{"TimeBudget", {"--time-budget", "1.5"}},
                                         Choosing{"TargetError", {"--target-error", ".02"}},
                                         Choosing{"TimeBudgetOfTheVolume",
                                                  {"--time-budget", "1.5", "--method", "volume_diffusion"}},
                                         Choosing{"TargetErrorOfTheVolume",
                                                  {"--target-error", ".3", "--method", "volume_diffusion"}}),
                         [](const auto& choosing) { return choosing.param.name; });

// Claim: stages that the trials of --target-error leave to the image are named on the trials' line, and a stage without a
// cost has no line. Fails if: a reused stage has a line.
TEST(CliQuality, StagesOfTheTrialsAreNamedWithThem) {
  const QualityFolder folder;
  const Outcome render = folder.render({"--target-error", ".02"});
  ASSERT_EQ(render.exit_code, 0) << render.err;
  EXPECT_TRUE(contains(closing_line(render.out, "choosing"), ", irradiance, octree")) << render.out;
  EXPECT_EQ(closing_line(render.out, "irradiance"), "") << render.out;
}

// Claim: spacings are repeated in the scene's own units where several groups have them. Fails if: they are in
// mm.
TEST(CliQuality, BudgetOfTwoGroupsIsRepeatedInSceneUnits) {
  const QualityFolder folder;
  put_bytes(folder.scene, R"({"mm_per_unit": 10, "media": {"marble": {"preset": "marble"}},
    "shapes": [{"name": "a", "sphere": {"center": [-1, 0, 0], "radius": 0.9}, "medium": "marble"},
               {"name": "b", "sphere": {"center": [1, 0, 0], "radius": 0.5}, "medium": "marble"}],
    "lights": [{"type": "point", "position": [2, 3, 4], "intensity": 1000}],
    "camera": {"position": [0, 0, 7]}, "film": {"resolution": [64, 64]}})");
  ASSERT_EQ(folder.render({"--time-budget", "1s", "--method", "hierarchical", "--quiet"}).exit_code, 0);
  const std::string command = metadata_of(folder.file("a.exr"), "opaline:command");
  std::vector<std::string> repeat;
  std::istringstream words(command.substr(command.find("--set")));
  for (std::string word; words >> word;) repeat.push_back(word);
  ASSERT_TRUE(contains(command, "sample_spacing")) << command;
  ASSERT_EQ(folder.render(repeat, "b.exr").exit_code, 0) << command;
  EXPECT_TRUE(
      std::ranges::equal(read_image(folder.file("a.exr")).pixels, read_image(folder.file("b.exr")).pixels));
  const Outcome own = folder.render(
      {"--time-budget", "1s", "--method", "hierarchical", "--set", "settings.max_samples=100000"});
  EXPECT_EQ(own.exit_code, 0) << own.err;
}

// Claim: too little time is a warning that says what the least is, hierarchical and direct; the picture is
// made. Fails if: either is silent, or an error.
TEST(CliQuality, TooLittleTimeIsSaid) {
  const QualityFolder folder;
  for (const char* method : {"hierarchical", "direct"}) {
    const Outcome outcome = folder.render({"--time-budget", "1ms", "--method", method});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "0.001 s of CPU is too small") &&
                contains(outcome.err, "opaline renders "))
        << outcome.err;
  }
}

// Claim: direct stops in time, and its command has the entry samples that it had.
TEST(CliQuality, DirectStopsInTime) {
  const QualityFolder folder;
  const Outcome json = folder.render({"--time-budget", "1.5s", "--method", "direct", "--log", "json"});
  ASSERT_EQ(json.exit_code, 0) << json.err;
  const nlohmann::json done = event_of(events_of(json.out), "done");
  EXPECT_GT(done["entry_samples"], 16);
  const std::string entries = "settings.entry_samples=" + std::to_string(int(done["entry_samples"]));
  EXPECT_TRUE(contains(done["again_by"], entries)) << done["again_by"];
}

// Claim: --until-error ends images of all methods of camera rays at this noise; the plan names it, and the closing line and the log
// state the rays, the noise and an error out of reach. Source: the documentation. Fails if: a method refuses the option, or the
// closing line omits the bound.
TEST(CliQuality, UntilErrorByEveryMethod) {
  const SceneFolder folder;
  const auto render = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", folder.scene, "-o", folder.file("a.exr"), "--resolution", "16x16"});
    return run_program(more);
  };
  for (const char* method :
       {"auto", "lambert", "preintegrated", "image_space", "hierarchical", "volume_diffusion"}) {
    const Outcome outcome = render({"--method", method, "--until-error", "5%", "--log", "json"});
    ASSERT_EQ(outcome.exit_code, 0) << method << outcome.err;
    const nlohmann::json rays = event_of(events_of(outcome.out), "done")["camera_rays"];
    EXPECT_LE(rays["noise"], .05) << method;
    EXPECT_GT(rays["noise"], 0) << method;
    EXPECT_GE(rays["mean"], 8) << method;
    EXPECT_GE(rays["most"], rays["mean"]) << method;
    EXPECT_EQ(rays["has_reached_error"], true) << method;
  }
  const Outcome text = render({"--until-error", "1e-6", "--crop", "0,0,2,2"});
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_TRUE(contains(text.out, "8 to 1,024 camera rays per pixel, until the noise is 0.0001 %"))
      << text.out;
  EXPECT_TRUE(contains(text.out, "\ncamera rays ")) << text.out;
  const Outcome bound = render({"--until-error", "1e-6", "--crop", "6,6,10,10", "--method", "lambert"});
  EXPECT_TRUE(contains(bound.out, "; the bound of 1,024 rays per pixel ended it above 0.0001 %"))
      << bound.out;
  const Outcome uniform = render({"--log", "json"});
  EXPECT_FALSE(event_of(events_of(uniform.out), "done").contains("camera_rays"));
}

// Claim: without lights the image is black, so that no error remains to be reached or measured; render names each option without
// effect, by every method, once for all frames, and succeeds. Source: by hand. Fails if: the options complain of the method that
// replaces the body's, settings are chosen, or an option is dropped without a word.
TEST(CliQuality, NoErrorWithoutLights) {
  const QualityFolder folder;
  const std::string black = "opaline: warning: the scene has no lights: the image is black\n";
  const auto unlit = [](const std::string& option) {
    return "opaline: warning: the scene has no lights, so " + option + " has no effect\n";
  };
  const std::vector<std::vector<std::string>> choices = {
      {"--target-error", "1%"}, {"--time-budget", "1s"},   {"--verify"},
      {"--until-error", "1%"},  {"--entry-samples", "64"}, {"--resume", "sums.exr"}};
  for (const std::vector<std::string>& options : choices)
    for (const char* method : {"hierarchical", "volume_diffusion", "lambert", "direct", "volume", "auto"}) {
      std::vector<std::string> words = options;
      words.insert(words.end(), {"--set", "lights=[]", "--method", method});
      const Outcome outcome = folder.render(words);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_EQ(outcome.err, unlit(options[0]) + black) << method;
    }
  const Outcome frames = folder.render(
      {"--set", "lights=[]", "--target-error", "1%", "--verify", "--frames", "1-2"}, "a.##.exr");
  EXPECT_EQ(frames.exit_code, 0) << frames.err;
  EXPECT_EQ(frames.err, unlit("--target-error") + unlit("--verify") + black);
}

// Claim: what makes no sense is exit 2 with what was expected, and nothing is written: values that are no
// error, settings that are chosen beside it, frames, methods without samples, the classic evaluator. Fails
// if: a check goes.
TEST(CliQuality, SenselessOptionsAreErrors) {
  const QualityFolder folder;
  const std::vector<std::pair<std::vector<std::string>, std::string>> senseless = {
      {{"--target-error", "banana"}, "expected a fraction such as 2%"},
      {{"--target-error", "0"}, "expected a fraction such as 2%"},
      {{"--target-error", "-1%"}, "expected a fraction such as 2%"},
      {{"--target-error", "150%"}, "expected a fraction such as 2%"},
      {{"--target-error", "1%", "--set", "settings.samples=100"}, "chooses settings.samples itself"},
      {{"--target-error", "1%", "--set", "settings.sample_spacing=1"},
       "chooses settings.sample_spacing itself"},
      {{"--target-error", "1%", "--set", "settings.tolerance=0.1"}, "chooses settings.tolerance itself"},
      {{"--target-error", "1%", "--method", "direct"}, "--until-error"},
      {{"--target-error", "1%", "--method", "lambert"}, "--method hierarchical"},
      {{"--verify", "--method", "lambert"}, "--method hierarchical"},
      {{"--target-error", "1%", "--evaluator", "classic"}, "classic"},
      {{"--time-budget", "banana"}, "--time-budget"},
      {{"--time-budget", "0"}, "--time-budget"},
      {{"--time-budget", "-1s"}, "--time-budget"},
      {{"--time-budget", "2 parsecs"}, "--time-budget"},
      {{"--time-budget", "1s", "--target-error", "1%"}, "one of the two"},
      {{"--time-budget", "1s", "--set", "settings.samples=100"}, "chooses settings.samples itself"},
      {{"--time-budget", "1s", "--cache", "stages"}, "--cache"},
      {{"--time-budget", "1s", "--samples-ply", "a.ply"}, "does not plan for --samples-ply"},
      {{"--time-budget", "1s", "--method", "lambert"}, "--method hierarchical, volume_diffusion or direct"},
      {{"--time-budget", "1s", "--method", "volume_diffusion", "--set", "settings.cell_size=1"},
       "--time-budget chooses settings.cell_size itself"},
      {{"--time-budget", "1s", "--evaluator", "classic"}, "classic"}};
  for (const auto& [options, expected] : senseless) {
    const Outcome outcome = folder.render(options);
    EXPECT_EQ(outcome.exit_code, 2) << expected;
    EXPECT_TRUE(contains(outcome.err, expected)) << expected << ": " << outcome.err;
  }
  const Outcome budget = folder.render({"--time-budget", "1s", "--frames", "1-2"}, "a.##.exr");
  EXPECT_EQ(budget.exit_code, 2);
  EXPECT_TRUE(contains(budget.err, "a single image first")) << budget.err;
  EXPECT_EQ(folder.entries(), 1u);
}

}  // namespace
}  // namespace opaline
