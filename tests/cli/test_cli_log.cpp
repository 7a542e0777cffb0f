// SPDX-License-Identifier: GPL-3.0-or-later
// The log of `opaline render`.
#include <gtest/gtest.h>

#include "run_program.h"

namespace opaline {
namespace {

// Claim: a JSON log is one object a line on stdout: plan, each stage once in order, done with the whole bill;
// and nothing on stderr. Source: log.h. Fails if: a text line slips in, or a stage is not noted.
TEST(CliLog, JsonLog) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr");
  const Outcome outcome =
      run_program({"render", folder.scene, "-o", out, "--log", "json", "--set",
                   R"(lights.key={"type":"sphere","center":[20,30,40],"radius":9,"radiance":1})"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_TRUE(outcome.err.empty()) << outcome.err;
  const auto events = events_of(outcome.out);
  std::vector<std::string> stages;
  for (const auto& event : events)
    if (event["event"] == "stage") stages.push_back(event["stage"]);
  EXPECT_EQ(stages, (std::vector<std::string>{"loading", "rays", "sampling", "irradiance", "octree",
                                              "shading", "writing"}));
  EXPECT_EQ(event_of(events, "plan")["groups"][0]["name"], "ball");
  EXPECT_EQ(events.back()["event"], "done");
  const nlohmann::json& done = events.back();
  EXPECT_EQ(done["stages"].size(), stages.size());
  EXPECT_EQ(done["outputs"], std::vector<std::string>{out});
  EXPECT_GT(done["samples"], 100);
  EXPECT_GE(done["shading_rays"], 32 * 32);
  EXPECT_GT(done["embree_cpu_seconds"], 0.0);
  EXPECT_GT(done["peak_memory_bytes"], 1000000);
  EXPECT_GT(done["irradiance_noise"][0]["relative_error"], 0.0);
}

// Claim: as text the bill names every stage, memory, samples, rays and the file, and a short run writes no
// progress into a log. With
// --quiet there is not a byte. Source: commands.h. Fails if: progress goes to stdout, or --quiet forgets a
// line.
TEST(CliLog, TextLogAndQuiet) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr");
  const Outcome text = run_program({"render", folder.scene, "-o", out});
  for (const char* part : {"loading ", "rays ", "sampling ", "irradiance ", "octree ", "shading ", "writing ",
                           "total ", "memory ", "samples ", "Mray", "wrote "})
    EXPECT_TRUE(contains(text.out, std::string("\n") + part) || contains(text.out, part)) << part;
  EXPECT_TRUE(contains(text.out, out));
  EXPECT_EQ(text.err, "");  // stages of a fraction of a second are not worth a line of a log
  const Outcome quiet = run_program({"render", folder.scene, "-o", out, "--quiet"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

// Claim: the closing lines state the error against random walks, with the settings' error and the model's as its parts, and warn
// of a model that is off by more than 20 %, or that its error is unknown. Source: expected_error.h. Fails if: the settings' error
// stands for all.
TEST(CliLog, TellsTheModelsError) {
  const SceneFolder folder;
  const std::string plate = std::string(OPALINE_SCENES_DIR) + "/backlit-slab.json";
  const Outcome thin = run_program({"render", plate, "-o", folder.file("a.exr"), "--resolution", "32x32",
                                    "--set", "settings.samples=2000", "--method", "hierarchical"});
  EXPECT_TRUE(contains(thin.out, " against random walks, of which\n            settings estimated "))
      << thin.out;
  EXPECT_TRUE(contains(thin.out, "model about ")) << thin.out;
  EXPECT_EQ(contains(thin.err, "expected model error "), contains(thin.out, "expected model error 2"))
      << thin.err;
  const Outcome thinner = run_program({"render", plate, "-o", folder.file("a.exr"), "--resolution", "32x32",
                                       "--set", "settings.samples=2000", "--method", "hierarchical", "--set",
                                       "shapes.slab.slab.thickness=0.5"});
  EXPECT_TRUE(contains(thinner.err, "slab: expected model error ")) << thinner.err;
  const Outcome thick = run_program({"render", folder.scene, "-o", folder.file("a.exr")});
  EXPECT_TRUE(contains(thick.out, "model about ")) << thick.out;
  EXPECT_EQ(thick.err, "");
  const Outcome unknown = run_program({"render", plate, "-o", folder.file("a.exr"), "--resolution", "32x32",
                                       "--set", "settings.samples=2000", "--method", "hierarchical", "--set",
                                       "media.jade.profile=better_dipole"});
  EXPECT_TRUE(contains(unknown.out, "error       settings estimated ") &&
              contains(unknown.out, "model: unknown for slab\n"))
      << unknown.out;
}

// Claim: a shape inside a translucent body, opaque or of another medium, is reported by methods that ignore it there, and not
// by `volume`, nor by `auto` if it is opaque; so are bodies that overlap, without a vertex in one another, once a pair. Neither a floor in the plane of its lower
// face nor a body that touches it, or reaches 0.1 of 20 mm into it, is. Source: shapes_inside.h. Fails if: shapes within a body
// are silent, vertices stand for a surface, or both bodies of a pair are named.
TEST(CliLog, ShapesInsideBodiesAreReported) {
  const ScratchFolder folder;
  const auto warning_of = [&](const std::string& shape, const std::string& method) {
    put_bytes(folder.file("a.json"),
              R"({"media": {"m": {"preset": "marble"}, "n": {"preset": "skin1"}}, "shapes": [
        {"name": "cube", "box": {"low": [0, 0, 0], "high": [20, 20, 20]}, "medium": "m"}, )" +
                  shape + R"(], "lights": [{"type": "point", "position": [30, 60, 60], "intensity": 9000}],
        "camera": {"position": [10, 30, 80], "look_at": [10, 8, 0]}, "film": {"resolution": [16, 16]},
        "settings": {"bounces": 0, "samples": 500, "until_error": 0.5}})");
    const std::string err =
        run_program({"render", folder.file("a.json"), "-o", folder.file("a.exr"), "--method", method}).err;
    EXPECT_FALSE(contains(err, "b: the shape 'cube'")) << err;
    return contains(err, "cube: the shape 'b' lies");
  };
  const std::string
      inside = R"({"name": "b", "box": {"low": [5, 5, 5], "high": [15, 15, 15]}})",
      overlapping = R"({"name": "b", "sphere": {"center": [20, 10, 10], "radius": 8}, "medium": "n"})",
      flush = R"({"name": "b", "box": {"low": [19, 0, 0], "high": [40, 20, 20]}, "medium": "n"})",
      large = R"({"name": "b", "box": {"low": [-500, -90, -500], "high": [500, 3, 500]}, "medium": "n"})",
      sunk = R"({"name": "b", "box": {"low": [-50, -90, -50], "high": [50, 0.1, 50]}, "medium": "n"})",
      floor = R"({"name": "b", "quad": {"corner": [-9, 0, -9], "u": [0, 0, 40], "v": [40, 0, 0]}})",
      beside = R"({"name": "b", "box": {"low": [20, 2, 2], "high": [30, 9, 9]}, "medium": "n"})";
  for (const char* method : {"auto", "hierarchical"}) {
    EXPECT_TRUE(warning_of(overlapping, method)) << method;
    EXPECT_TRUE(warning_of(flush, method)) << method;
    EXPECT_TRUE(warning_of(large, method)) << method;
    EXPECT_FALSE(warning_of(sunk, method)) << method;
    EXPECT_FALSE(warning_of(floor, method)) << method;
    EXPECT_FALSE(warning_of(beside, method)) << method;
  }
  EXPECT_TRUE(warning_of(inside, "hierarchical"));
  for (const char* method : {"auto", "volume"}) EXPECT_FALSE(warning_of(inside, method)) << method;
}

}  // namespace
}  // namespace opaline
