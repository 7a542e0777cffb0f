// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline render --target-error --verify`: what it says, and what it does not take.
#include <algorithm>

#include "opaline/image/image.h"
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
  const std::size_t at = text.out.find("\nerror ");
  ASSERT_NE(at, std::string::npos) << text.out;
  const std::string line = text.out.substr(at + 1, text.out.find('\n', at + 1) - at - 1);
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
  EXPECT_TRUE(contains(outcome.err, "cannot be reached") && contains(outcome.err, "max_samples of 3000"))
      << outcome.err;
  put_bytes(folder.scene, R"({"shapes": [{"name": "ball", "sphere": {"radius": 10}}],
    "lights": [{"type": "point", "position": [20, 30, 40], "intensity": 1000}],
    "camera": {"position": [0, 0, 50]}, "film": {"resolution": [32, 32]}})");
  const Outcome opaque = folder.render({"--target-error", "1%", "--verify"});
  EXPECT_EQ(opaque.exit_code, 0) << opaque.err;
  EXPECT_TRUE(contains(opaque.err, "promises nothing")) << opaque.err;
}

// Claim: what makes no sense is exit 2 with what was expected, and nothing is written: values that are no
// error, settings that are chosen beside it, frames, methods without samples, the classic evaluator. Fails
// if: a check goes.
TEST(CliQuality, SenselessOptionsAreErrors) {
  const QualityFolder folder;
  const std::vector<std::pair<std::vector<std::string>, std::string>> senseless = {
      {{"--target-error", "banana"}, "expected a share such as 2%"},
      {{"--target-error", "0"}, "expected a share such as 2%"},
      {{"--target-error", "-1%"}, "expected a share such as 2%"},
      {{"--target-error", "150%"}, "expected a share such as 2%"},
      {{"--target-error", "1%", "--set", "settings.samples=100"}, "chooses settings.samples itself"},
      {{"--target-error", "1%", "--set", "settings.sample_spacing=1"},
       "chooses settings.sample_spacing itself"},
      {{"--target-error", "1%", "--set", "settings.tolerance=0.1"}, "chooses settings.tolerance itself"},
      {{"--target-error", "1%", "--method", "direct"}, "--until-error"},
      {{"--target-error", "1%", "--method", "lambert"}, "--method hierarchical"},
      {{"--verify", "--method", "lambert"}, "--method hierarchical"},
      {{"--target-error", "1%", "--evaluator", "classic"}, "classic"}};
  for (const auto& [options, expected] : senseless) {
    const Outcome outcome = folder.render(options);
    EXPECT_EQ(outcome.exit_code, 2) << expected;
    EXPECT_TRUE(contains(outcome.err, expected)) << expected << ": " << outcome.err;
  }
  const Outcome frames = folder.render({"--target-error", "1%", "--frames", "1-2"}, "a.##.exr");
  EXPECT_EQ(frames.exit_code, 2);
  EXPECT_TRUE(contains(frames.err, "a single picture first")) << frames.err;
  EXPECT_EQ(folder.entries(), 1u);
}

}  // namespace
}  // namespace opaline
