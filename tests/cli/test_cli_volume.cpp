// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline render --method volume`: stopped and gone on with, and ended by its noise.
#include <algorithm>

#include "opaline/image.h"
#include "run_program.h"
#include "session/walk_file.h"

namespace opaline {
namespace {

std::vector<std::string> volume(const SceneFolder& folder, const std::string& out,
                                const std::vector<std::string>& more) {
  std::vector<std::string> line{"render", folder.scene,          "-o",       folder.file(out),
                                "--set",  "settings.samples=60", "--method", "volume"};
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

std::size_t walked_passes(const std::string& path) {
  std::size_t passes = 0;
  for (const auto& [key, source] : read_walks(path))
    for (const WalkSums& channel : source.channels) passes += channel.passes;
  return passes;
}

// Claim: stopped by Ctrl-C, random walks keep their sums, say where and by which command to go on, leave the old
// picture, and go on to the bytes of walks in one go; finished ones go on to a smaller error, and to another camera
// and other colours without a walk. Source: the help. Tolerance: none. Fails if: sums are not written on the way out,
// are kept with fewer digits than they have, or passes begin again at 0.
TEST(CliVolume, InterruptedAndResumedIsTheSameAsInOneGo) {
  const SceneFolder folder;
  const std::string sums = folder.file("sums.exr");
  put_bytes(folder.file("a.exr"), "old");
  Child child(volume(folder, "a.exr", {"--until-error", ".01%", "--resume", sums, "--log", "json"}));
  ASSERT_TRUE(child.prints(R"({"event":"progress","stage":"random walks")"));
  ASSERT_TRUE(child.prints(R"("noise":)"));
  child.send(SIGINT);
  const Outcome stopped = child.wait(60);
  EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
  const std::string said = event_of(events_of(stopped.out), "error")["message"];
  EXPECT_TRUE(contains(said, sums + " stores the sums of ") &&
              contains(said, " passes of random walks; resume with "))
      << said;
  EXPECT_TRUE(said.ends_with("--until-error .01% --resume " + sums + " --log json")) << said;
  EXPECT_EQ(bytes_of(folder.file("a.exr")), "old");
  const std::size_t passes = walked_passes(sums);
  ASSERT_GT(passes, 0u);

  const std::string part = folder.file("part.exr");
  const auto run = [&](const std::string& out, std::vector<std::string> more) {
    more.push_back("--quiet");
    const Outcome outcome = run_program(volume(folder, out, more));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  };
  run("part.png", {"--until-error", "20%", "--resume", part});
  const std::size_t before = walked_passes(part);
  run("a.exr", {"--until-error", "9%", "--resume", part});
  EXPECT_GT(walked_passes(part), before);
  run("b.exr", {"--until-error", "9%"});
  EXPECT_TRUE(bytes_of(folder.file("a.exr")) == bytes_of(folder.file("b.exr")));
  const std::size_t all = walked_passes(part);
  run("c.exr",
      {"--until-error", "9%", "--resume", part, "--resolution", "16x16", "--set", "lights.key.intensity=3"});
  EXPECT_EQ(walked_passes(part), all);
}

// Claim: sums of another scene, and files that are none, are exit 2 naming the file, which stays. Source: the help. Fails
// if: the walks' keys leave out the seed or the medium.
TEST(CliVolume, SumsOfAnotherSceneAreAnError) {
  const SceneFolder folder;
  const std::string sums = folder.file("sums.exr");
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--resume", sums, "--quiet", "--until-error", "50%"});
    return run_program(volume(folder, "a.exr", more));
  };
  ASSERT_EQ(run({}).exit_code, 0);
  const std::string before = bytes_of(sums);
  for (const std::vector<std::string>& other : {std::vector<std::string>{"--seed", "3"},
                                                {"--set", "media.marble.specular_ior=1.2"},
                                                {"--set", "settings.reenter=false"}}) {
    const Outcome outcome = run(other);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_TRUE(contains(outcome.err, sums + ": the sums belong to another scene")) << outcome.err;
  }
  EXPECT_TRUE(bytes_of(sums) == before);
  put_bytes(sums, before.substr(0, before.size() / 2));
  const Outcome damaged = run({});
  EXPECT_EQ(damaged.exit_code, 2);
  EXPECT_TRUE(contains(damaged.err, sums + ": holds no sums to resume from: ")) << damaged.err;
  EXPECT_TRUE(contains(damaged.err, "or a new file name")) << damaged.err;
  ASSERT_EQ(run_program({"render", folder.scene, "-o", sums, "--quiet"}).exit_code, 0);  // a picture
  const Outcome picture = run({});
  EXPECT_EQ(picture.exit_code, 2);
  EXPECT_TRUE(contains(picture.err, sums + ": does not hold the sums of random walks")) << picture.err;
}

// Claim: --until-error ends at that noise, and the bill says what was reached, how many walks it took, and the
// picture's estimated error; walks end at no time budget. Source: the help. Fails if: the noise is another figure than
// the one that ends the walks.
TEST(CliVolume, UntilError) {
  const SceneFolder folder;
  const Outcome outcome = run_program(volume(folder, "a.exr", {"--until-error", "10%", "--log", "json"}));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json done = event_of(events_of(outcome.out), "done");
  EXPECT_LE(done["walk_noise"], .1) << done;
  EXPECT_GT(done["walk_noise"], .07) << done;
  EXPECT_GT(done["walks"], 32) << done;
  EXPECT_GT(done["estimated_error"], .01) << done;
  const Outcome text = run_program(volume(folder, "a.exr", {"--until-error", "30%"}));
  EXPECT_TRUE(contains(text.out, "noise ") && contains(text.out, "estimated ")) << text.out;
  const Outcome budget = run_program(
      {"render", folder.scene, "-o", folder.file("a.exr"), "--method", "volume", "--time-budget", "2s"});
  EXPECT_EQ(budget.exit_code, 2);
  EXPECT_TRUE(contains(budget.err, "--until-error")) << budget.err;
}

// Claim: warnings report defects of a body's meshes found by random walks: holes, overlapping parts, other shapes
// inside. Source: cell_warnings.cpp. Fails if: a warning is missing, or separate parts count as overlapping.
TEST(CliVolume, WarnsOfBadBodies) {
  const SceneFolder folder;
  const auto said = [&](const std::string& shapes) {
    const Outcome outcome = run_program(volume(folder, "a.exr", {"--set", "shapes=" + shapes}));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.err;
  };
  const std::string ball = R"({"name":"ball","sphere":{"radius":10},"medium":"marble","group":"g"})";
  EXPECT_FALSE(contains(said("[" + ball + "]"), "walk"));
  EXPECT_TRUE(contains(said(R"([{"quad":{"corner":[-5,-5,0],"u":[10,0,0],"v":[0,10,0]},"medium":"marble"}])"),
                       "leaks through holes"));
  EXPECT_TRUE(contains(
      said("[" + ball + R"(,{"sphere":{"radius":4,"center":[9,0,0]},"medium":"marble","group":"g"}])"),
      "parts of the surface lie inside"));
  EXPECT_FALSE(contains(
      said("[" + ball + R"(,{"sphere":{"radius":4,"center":[30,0,0]},"medium":"marble","group":"g"}])"),
      "parts of the surface lie inside"));
  EXPECT_TRUE(contains(said("[" + ball + R"(,{"sphere":{"radius":6,"center":[9,0,0]}}])"),
                       "ends at other shapes inside"));
}

double mean_of(const std::string& path, const char* channel) {
  const Image image = read_image(path);
  const std::size_t stride = image.channels.size(),
                    place = std::size_t(std::ranges::find(image.channels, channel) - image.channels.begin());
  double sum = 0;
  for (std::size_t at = place; at < image.pixels.size(); at += stride) sum += double(image.pixels[at]);
  return sum / double(image.pixels.size() / stride);
}

bool says_not_finite(const std::string& text) {
  for (const char* word : {" inf", "inf ", "nan"})
    if (contains(text, word)) return true;
  return false;
}

// Claim: a channel without a mean free path is diffuse reflection, by each method, alone or all three, and no text says inf
// or nan. Source: the limit of a vanishing mean free path. Tolerance: 2 %, 8 % of walks' noise. Fails if: cells
// take it for no matter (0), or a length is a quotient of zeros.
TEST(CliVolume, NoMeanFreePathIsDiffuseReflection) {
  const ScratchFolder folder;
  const std::string scene = std::string(OPALINE_TEST_INPUTS) + "/radius0.json", out = folder.file("a.exr");
  for (const std::string radius : {"[3, 0.5, 0]", "[0, 0, 0]"}) {
    const auto blue_of = [&](const std::string& method) {
      const Outcome outcome =
          run_program({"render", scene, "-o", out, "--method", method, "--set",
                       "media.a.subsurface_radius=" + radius, "--set", "film.resolution=[32,32]", "--set",
                       method == "volume" ? "settings.samples=300" : "settings.seed=1"});
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_FALSE(says_not_finite(outcome.out + outcome.err)) << outcome.out << outcome.err;
      return mean_of(out, "B");
    };
    const double expected = blue_of("lambert");
    EXPECT_NEAR(expected, .0215, .0005);
    for (const char* method : {"hierarchical", "volume_diffusion", "direct"})
      EXPECT_NEAR(blue_of(method) / expected, 1, .02) << method << " " << radius;
    EXPECT_NEAR(blue_of("volume") / expected, 1, .08) << radius;
    const Outcome plan = run_program({"info", scene, "--set", "media.a.subsurface_radius=" + radius});
    EXPECT_FALSE(says_not_finite(plan.out)) << plan.out;
  }
}

// Claim: a body whose mesh is open is left to its radial profile, pixel by pixel as by hierarchical, and render says so. Source:
// an open mesh encloses no volume. Fails if: cells are made in it, or nothing is said.
TEST(CliVolume, CellsLeaveOpenMeshesToProfiles) {
  const SceneFolder folder;
  const auto render = [&](const std::string& method) {
    const Outcome outcome = run_program(
        {"render", folder.scene, "-o", folder.file("a.exr"), "--method", method, "--set",
         R"(shapes=[{"name":"leaf","quad":{"corner":[-5,-5,0],"u":[10,0,0],"v":[0,10,0]},"medium":"marble"}])"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(contains(outcome.err,
                       "leaf: its mesh is open (4 boundary edges) and encloses no volume; "
                       "uses hierarchical evaluation instead of volume_diffusion; use a closed shape"),
              method != "hierarchical")
        << outcome.err;
    return read_image(folder.file("a.exr")).pixels;
  };
  EXPECT_EQ(render("volume_diffusion"), render("hierarchical"));
}

// Claim: the closing line of bounces says that re-entry is part of it. Source: the plan's stage "re-entry". Fails if: a body that
// gathers its own light alone has a line of bounces without a word of re-entry.
TEST(CliVolume, ClosingLinesNameReentry) {
  const SceneFolder folder;
  const std::string balls =
      R"(shapes=[{"name":"a","sphere":{"radius":10},"medium":"marble","group":"g"},)"
      R"({"name":"b","sphere":{"radius":4,"center":[30,0,0]},"medium":"marble","group":"g"}])";
  const Outcome outcome = run_program({"render", folder.scene, "-o", folder.file("a.exr"), "--method",
                                       "volume_diffusion", "--set", balls, "--set", "settings.cell_size=4"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "\n            re-entry: ")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, " s CPU   re-entry included\n")) << outcome.out;
}

// Claim: a warning reports the part of a body's surface that cells leave out. Source: volume_diffusion_method.cpp.
// Fails if: a ball in a ball causes no warning, or two separate balls cause one.
TEST(CliVolume, CellsSayWhatTheyLeaveOut) {
  const SceneFolder folder;
  const auto said = [&](const std::string& place) {
    const std::string balls = R"(shapes=[{"name":"a","sphere":{"radius":10},"medium":"marble","group":"g"},)"
                              R"({"name":"b","sphere":{"radius":4,"center":)" +
                              place + R"(},"medium":"marble","group":"g"}])";
    const Outcome outcome =
        run_program({"render", folder.scene, "-o", folder.file("a.exr"), "--method", "volume_diffusion",
                     "--set", balls, "--set", "settings.cell_size=4"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.err;
  };
  EXPECT_TRUE(contains(said("[1,0,0]"), "g: 14 % of the surface lies inside the body or overlaps itself"));
  EXPECT_EQ(said("[30,0,0]"), "");
}

}  // namespace
}  // namespace opaline
