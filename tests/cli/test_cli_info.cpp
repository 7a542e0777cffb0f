// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline info`: the plan, and nothing else.
#include <gtest/gtest.h>

#include "run_program.h"

namespace opaline {
namespace {

// Claim: the plan says what there is, how many samples and why, and what memory; info writes no file.
// Source: the design ("shows the plan"). Fails if: a member is left out, or info renders.
TEST(CliInfo, PlanAsTextAndJson) {
  const SceneFolder folder;
  const Outcome text = run_program({"info", folder.scene}, folder.path.string());
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_TRUE(text.err.empty()) << text.err;
  for (const char* part :
       {"32 x 32", "key (point)", "ball of marble", "500 samples", "settings.samples", "memory"})
    EXPECT_TRUE(contains(text.out, part)) << "no \"" << part << "\" in:\n" << text.out;

  const Outcome json = run_program({"info", folder.scene, "--log", "json"}, folder.path.string());
  const nlohmann::json plan = event_of(events_of(json.out), "plan");
  EXPECT_EQ(plan["groups"][0]["samples"], 500);
  EXPECT_EQ(plan["groups"][0]["shapes"], (std::vector<std::string>{"ball"}));
  EXPECT_EQ(plan["groups"][0]["reason"], "settings.samples");
  EXPECT_NEAR(plan["groups"][0]["area_mm2"].get<double>(), 400 * 3.14159265, 2);
  EXPECT_EQ(plan["lights"][0]["type"], "point");
  EXPECT_GT(plan["memory_bytes"], 1000000);
  EXPECT_EQ(folder.entries(), 1u);
}

// Claim: the plan's mean free path is that of the smallest channel, or of the smallest that scatters inside where another does not.
// Source: a channel of radius 0 reflects diffusely. Fails if: 0.5 mm is called the smallest of 3, 0.5 and 0 mm.
TEST(CliInfo, MeanFreePathNamesItsChannels) {
  const SceneFolder folder;
  const auto info = [&](const std::string& radius) {
    return run_program({"info", folder.scene, "--set",
                        "media.marble={\"subsurface_color\": 0.8, \"subsurface_radius\": " + radius + "}"})
        .out;
  };
  EXPECT_TRUE(contains(info("[3, 0.5, 1]"), "mean free path 0.5 mm (smallest channel)"))
      << info("[3, 0.5, 1]");
  EXPECT_TRUE(contains(info("[3, 0.5, 0]"), "mean free path 0.5 mm (smallest channel that scatters inside)"))
      << info("[3, 0.5, 0]");
}

// Claim: the model's error in a thin plate is said, beside random walks; not where a plate is thick, or a
// body is none. Fails if: the truth is left out, or a ball is taken for a plate.
TEST(CliInfo, ModelErrorOfPlates) {
  const std::string plate = std::string(OPALINE_SCENES_DIR) + "/backlit-slab.json";
  const Outcome thin = run_program({"info", plate});
  EXPECT_TRUE(contains(
      thin.out, "model error slab has the thickness of a plate of 1.85 mm: 3.08 1.85 2.64 mean free paths"))
      << thin.out;
  EXPECT_TRUE(contains(thin.out, "random walks (reference): ")) << thin.out;
  const Outcome dipole = run_program({"info", plate, "--log", "json", "--set", "media.jade.profile=dipole"});
  const nlohmann::json event = event_of(events_of(dipole.out), "plate");
  EXPECT_GT(event["channels"][1]["profile"]["back"], .8);
  EXPECT_LT(event["channels"][1]["random_walks"]["back"], .5);
  // In a group of its own name, with a channel that is thick.
  const Outcome grouped = run_program({"info", plate, "--set", "shapes.slab.group=\"leaf\"", "--set",
                                       "media.jade.subsurface_radius=[1, 0.1, 1]", "--set",
                                       "media.jade.profile=\"normalized_diffusion\""});
  EXPECT_TRUE(
      contains(grouped.out, "leaf has the thickness of a plate of 1.85 mm: 3.08 - 2.64 mean free paths"))
      << grouped.out;
  EXPECT_TRUE(contains(grouped.out, "`normalized_diffusion` reflects")) << grouped.out;
  const Outcome thick = run_program({"info", plate, "--set", "media.jade.subsurface_radius=0.1"});
  EXPECT_FALSE(contains(thick.out, "\nmodel error")) << thick.out;
  EXPECT_FALSE(contains(run_program({"info", SceneFolder().scene}).out, "\nmodel error"));
}

// Claim: the plan says which profile each body has, why, and what error against random walks to expect of it and of
// volume_diffusion; of a named profile that it is named. Source: choose_models.h. Fails if: info or the JSON leave the
// choice to the reader, or a named profile is told as chosen.
TEST(CliInfo, ModelAndItsError) {
  const std::string plate = std::string(OPALINE_SCENES_DIR) + "/backlit-slab.json";
  const Outcome text = run_program({"info", plate, "--method", "hierarchical"});
  for (const char* part : {"profile multipole: flat, thickness 2 mm = ", "expected model error ",
                           " %; --method volume_diffusion: "})
    EXPECT_TRUE(contains(text.out, part)) << "no \"" << part << "\" in:\n" << text.out;
  const auto model_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"info", plate, "--log", "json"};
    words.insert(words.end(), more.begin(), more.end());
    return event_of(events_of(run_program(words).out), "plan")["groups"][0]["model"];
  };
  const nlohmann::json chosen = model_of({});
  EXPECT_EQ(chosen["profile"], "multipole");
  EXPECT_EQ(chosen["is_chosen"], true);
  EXPECT_GT(chosen["expected_error"], chosen["expected_error_of_volume_diffusion"]);
  const nlohmann::json named = model_of({"--set", "media.jade.profile=better_dipole"});
  EXPECT_EQ(named["profile"], "better_dipole");
  EXPECT_EQ(named["is_chosen"], false);
  EXPECT_FALSE(named.contains("expected_error"));
  EXPECT_TRUE(contains(run_program({"info", plate, "--method", "volume_diffusion"}).out,
                       "expected model error 3.7 %\n"))
      << text.out;
}

// Claim: a body whose mean free path asks for few samples has the least, and says so; where bodies are many the least
// falls. Source: plan_samples.cpp. Fails if: 300 bodies have 10,000 samples each.
TEST(CliInfo, FewerSamplesWhereBodiesAreMany) {
  const SceneFolder folder;
  const auto plan_of = [&](int bodies) {
    std::string shapes;
    for (int i = 0; i < bodies; ++i)
      shapes += (i > 0 ? "," : "") + std::string(R"({"box":{"low":[)") + std::to_string(3 * i) +
                R"(,0,0],"high":[)" + std::to_string(3 * i + 2) + R"(,2,2]},"medium":"marble"})";
    const std::vector<std::string> line{"info",  folder.scene,
                                        "--set", "shapes=[" + shapes + "]",
                                        "--set", "settings={\"method\": \"hierarchical\"}"};
    return run_program(line).out;
  };
  EXPECT_TRUE(contains(plan_of(2), "10,000 samples (the minimum)")) << plan_of(2);
  const std::string many = plan_of(300);
  EXPECT_TRUE(contains(many, "6,667 samples (the minimum)")) << many;
  EXPECT_TRUE(contains(many, "and 250 more bodies")) << many;
}

// Claim: a plan's warnings are on stderr, or events. Source: plan.h. Fails if: warnings are dropped.
TEST(CliInfo, WarningsAreSaid) {
  const SceneFolder folder;
  const std::vector<std::string> dark{"info", folder.scene, "--set", "lights=[]"};
  EXPECT_TRUE(run_program(dark).err.starts_with("opaline: warning: the scene has no lights"));
  const Outcome near = run_program({"info", folder.scene, "--set", "lights.key.position=[0, 0, 10.1]"});
  EXPECT_TRUE(near.err.starts_with("opaline: warning: ball: the light key is 0.1")) << near.err;
  std::vector<std::string> as_json = dark;
  as_json.insert(as_json.end(), {"--log", "json"});
  const Outcome outcome = run_program(as_json);
  EXPECT_TRUE(contains(event_of(events_of(outcome.out), "warning")["message"], "no lights"));
  EXPECT_TRUE(outcome.err.empty()) << outcome.err;
}

// Claim: the scenes of the repository that need no mesh file are right. Fails if: a key changes its name.
TEST(CliInfo, ScenesOfTheRepository) {
  for (const char* name : {"sphere.json", "backlit-slab.json"}) {
    const Outcome outcome = run_program({"info", std::string(OPALINE_SCENES_DIR) + "/" + name});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(outcome.err.empty()) << outcome.err;
  }
}

// Claim: what `direct` draws is said as whole passes draw it. Fails if: what was asked for is said.
TEST(CliInfo, WholePassesOfDirect) {
  const SceneFolder folder;
  const Outcome seven = run_program({"info", folder.scene, "--method", "direct", "--entry-samples", "7"});
  EXPECT_TRUE(contains(seven.out, "direct, 16 entry samples per pixel")) << seven.out;
}

// Claim: a plan that nobody can read is a failure. Source: commands.h. Fails if: ferror is not looked at.
TEST(CliInfo, FullStandardOutput) {
  const SceneFolder folder;
  const Outcome outcome = run_program({"info", folder.scene}, ".", {.file_size = 10, .address_space = {}});
  EXPECT_EQ(outcome.exit_code, 3);
}

// Claim: the program starts without OpenImageIO and the libraries that it brings along, .2 s of CPU: only
// what reads a picture loads them. Source: picture_reader.h. Fails if: it is linked again, by anything.
TEST(CliStart, LoadsNoPictureReader) {
  ::setenv("LD_TRACE_LOADED_OBJECTS", "1", 1);  // ld.so(8): names the libraries instead of starting
  const Outcome libraries = run_program({"--version"});
  ::unsetenv("LD_TRACE_LOADED_OBJECTS");
  EXPECT_TRUE(contains(libraries.out, "libembree")) << libraries.out;
  EXPECT_FALSE(contains(libraries.out, "libOpenImageIO.so")) << libraries.out;
}

// Claim: a render takes at most the memory that the plan says, and at least two thirds of it: a thin body in fine cells, random
// walks beside a far coarser ball, a surface cache, a small light in a large image. Source: the design (an upper bound within
// 1.5; bench_plan renders 500 random scenes). Fails if: cells are counted by the area alone, pieces of triangles in the voxels
// of walks by the area alone, a cache by the places that it may have, or all pixels count where a lamp can be seen.
TEST(CliInfo, MemoryIsAnUpperBound) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer takes memory of its own";
#endif
  const std::string plate = R"("slab": {"center": [0, 0, 0], "width": 40, "depth": 40, "thickness": 0.4})",
                    ball = R"("sphere": {"center": [0, 0, 0], "radius": 10})";
  const std::string small_lamp = R"({"type": "sphere", "center": [0, 20, 0], "radius": 1, "radiance": 20})",
                    sun = R"({"type": "directional", "direction": [0, -1, -0.3], "irradiance": 2})";
  const struct {
    std::string shape, light, settings;
    int side;
  } scenes[] = {{plate, sun, R"("method": "volume_diffusion")", 64},
                {plate, sun, R"("method": "volume", "samples": 200, "until_error": 0.9)", 64},
                {ball, sun, R"("evaluator": "surface_cache", "samples": 100000)", 64},
                {ball, small_lamp, R"("method": "lambert")", 1500}};
  for (const auto& [shape, light, settings, side] : scenes) {
    const ScratchFolder folder;
    put_bytes(
        folder.file("scene.json"),
        R"({"media": {"m": {"sigma_a": 0.01, "sigma_s_prime": 5}}, "shapes": [{)" + shape +
            R"(, "medium": "m"}], "lights": [)" + light +
            R"(], "camera": {"position": [0, 60, 90], "look_at": [0, 0, 0]}, "film": {"resolution": [)" +
            std::to_string(side) + ", " + std::to_string(side) + R"(]}, "settings": {)" + settings + "}}");
    const auto events = events_of(
        run_program({"render", folder.file("scene.json"), "-o", folder.file("o.exr"), "--log", "json"}).out);
    const double planned = event_of(events, "plan")["memory_bytes"],
                 peak = event_of(events, "done")["peak_memory_bytes"];
    EXPECT_GE(planned / peak, 1) << shape << settings;
    EXPECT_LE(planned / peak, 1.5) << shape << settings;
  }
}

}  // namespace
}  // namespace opaline
