// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline render --method direct`: stopped and gone on with, and ended by its noise.
#include <algorithm>

#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

std::vector<std::string> direct(const SceneFolder& folder, const std::string& out,
                                const std::vector<std::string>& more) {
  std::vector<std::string> line{"render", folder.scene, "-o", folder.file(out), "--method", "direct"};
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

std::size_t passes_in(const std::string& path) {
  for (const auto& [name, value] : read_image(path).metadata)
    if (name == "opaline:direct_passes") return std::stoul(value);
  return 0;
}

// Claim: stopped by Ctrl-C, a rendering keeps its sums, says where and by which command to go on, leaves the
// old picture, and goes on to the bytes of one in one go; a finished one goes on to more samples. Source: the
// design. Tolerance: none. Fails if: the sums are not written on the way out, cannot be read back, or passes
// begin again at 0.
TEST(CliDirect, InterruptedAndResumedIsTheSameAsInOneGo) {
  const SceneFolder folder;
  const std::string sums = folder.file("sums.exr");
  put_bytes(folder.file("a.exr"), "old");
  Child child(direct(folder, "a.exr", {"--entry-samples", "100000000", "--resume", sums, "--log", "json"}));
  ASSERT_TRUE(child.prints(R"({"event":"progress","stage":"shading")"));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  child.send(SIGINT);
  const Outcome stopped = child.wait(20);
  EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
  const std::string said = event_of(events_of(stopped.out), "error")["message"];
  EXPECT_TRUE(contains(said, sums + " stores the sums of ") &&
              contains(said, " entry samples per pixel; resume with "))
      << said;
  EXPECT_TRUE(said.ends_with("--entry-samples 100000000 --resume " + sums + " --log json")) << said;
  EXPECT_EQ(bytes_of(folder.file("a.exr")), "old");
  const std::size_t passes = passes_in(sums);
  ASSERT_GT(passes, 0u);

  for (const std::size_t more : {3, 5}) {
    const std::string samples = std::to_string(16 * (passes + more));
    const Outcome resumed =
        run_program(direct(folder, "a.exr", {"--entry-samples", samples, "--resume", sums, "--quiet"}));
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(passes_in(sums), passes + more);
    ASSERT_EQ(run_program(direct(folder, "b.exr", {"--entry-samples", samples, "--quiet"})).exit_code, 0);
    EXPECT_TRUE(bytes_of(folder.file("a.exr")) == bytes_of(folder.file("b.exr"))) << more;
  }
  EXPECT_EQ(folder.entries(), 4u);  // the scene, two pictures, the sums
}

// Claim: an image of several groups of wavelengths is rendered with its samples as given; continuing it, or stopping at
// an error or a time, is exit 2 with both ways out. Source: the documentation. Fails if: the first group alone is
// summed, or stopped.
TEST(CliDirect, GroupsOfWavelengthsHaveNoSums) {
  const SceneFolder folder;
  const std::vector<std::string> six{"--set", "film.wavelengths=6", "--entry-samples", "16", "--quiet"};
  EXPECT_EQ(run_program(direct(folder, "a.exr", six)).exit_code, 0);
  for (const std::vector<std::string>& one : std::vector<std::vector<std::string>>{
           {"--resume", folder.file("sums.exr")}, {"--until-error", "1%"}, {"--time-budget", "2s"}}) {
    std::vector<std::string> line = direct(folder, "b.exr", {"--set", "film.wavelengths=6"});
    line.insert(line.end(), one.begin(), one.end());
    const Outcome refused = run_program(line);
    EXPECT_EQ(refused.exit_code, 2) << one[0];
    EXPECT_TRUE(contains(refused.err, "cannot stop at an error or a time") &&
                contains(refused.err, "--set film.wavelengths=3, or --entry-samples N, got 6 wavelengths"))
        << refused.err;
  }
  EXPECT_EQ(folder.entries(), 2u);  // the scene, one image
}

// Claim: sums of another scene, and files that are none, are exit 2 naming the file, which stays; another
// number of threads or of samples is no other scene. Source: metadata.h. Fails if: the key leaves out
// overrides.
TEST(CliDirect, SumsOfAnotherSceneAreAnError) {
  const SceneFolder folder;
  const std::string sums = folder.file("sums.exr");
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--resume", sums, "--quiet"});
    return run_program(direct(folder, "a.exr", more));
  };
  ASSERT_EQ(run({"--entry-samples", "16"}).exit_code, 0);
  EXPECT_EQ(run({"--entry-samples", "32", "--threads", "1"}).exit_code, 0);
  EXPECT_EQ(passes_in(sums), 2u);
  const std::string before = bytes_of(sums);
  for (const std::vector<std::string>& other : {std::vector<std::string>{"--seed", "3"},
                                                {"--resolution", "16x16"},
                                                {"--set", "lights.key.intensity=3"}}) {
    const Outcome outcome = run(other);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_TRUE(contains(outcome.err, sums + ": the sums belong to another scene")) << outcome.err;
  }
  EXPECT_TRUE(bytes_of(sums) == before);
  put_bytes(sums, before.substr(0, before.size() / 2));
  EXPECT_EQ(run({}).exit_code, 2);
  put_bytes(sums, "no picture");
  const Outcome outcome = run({});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(contains(outcome.err, sums)) << outcome.err;
  EXPECT_EQ(bytes_of(sums), "no picture");
}

// Claim: --until-error ends at that noise, as a percentage or a fraction, and the bill says what was reached.
// Source: arguments.h. Fails if: 5% is taken for 5.
TEST(CliDirect, UntilError) {
  const SceneFolder folder;
  for (const std::string error : {"5%", "0.05"}) {
    const Outcome outcome = run_program(
        direct(folder, "a.exr", {"--until-error", error, "--log", "json", "--resolution", "16x16"}));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const nlohmann::json done = event_of(events_of(outcome.out), "done");
    EXPECT_LE(done["direct_noise"], .05) << done;
    EXPECT_GT(done["direct_noise"], .04) << done;
  }
  const Outcome text =
      run_program(direct(folder, "a.exr", {"--until-error", "30%", "--resolution", "16x16"}));
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_TRUE(contains(text.out, "entry samples") || contains(text.out, "noise")) << text.out;
}

// Claim: what makes no sense is said with what was expected, exit 2, and nothing is written: errors that are
// none, sums without direct, a file of sums where none can be written (exit 3, before the work). Source:
// arguments.h. Fails if: a check goes.
TEST(CliDirect, SenselessOptionsAreErrors) {
  const SceneFolder folder;
  for (const std::string error : {"banana", "0", "-1%", "nan"}) {
    const Outcome outcome = run_program(direct(folder, "a.exr", {"--until-error", error}));
    EXPECT_EQ(outcome.exit_code, 2) << error;
    EXPECT_TRUE(contains(outcome.err, "until-error") || contains(outcome.err, "until_error")) << outcome.err;
  }
  const Outcome banana = run_program(direct(folder, "a.exr", {"--until-error", "banana"}));
  EXPECT_TRUE(contains(banana.err, "banana")) << banana.err;
  EXPECT_EQ(run_program(direct(folder, "a.exr", {"--entry-samples", "0"})).exit_code, 2);

  for (const char* method : {"hierarchical", "lambert"}) {
    const Outcome outcome = run_program({"render", folder.scene, "-o", folder.file("a.exr"), "--method",
                                         method, "--resume", folder.file("sums.exr")});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_TRUE(contains(outcome.err, "sums.exr") && contains(outcome.err, "--method direct")) << outcome.err;
  }
  const std::string nowhere = folder.file("missing/sums.exr");
  const Outcome unwritable = run_program(direct(folder, "a.exr", {"--resume", nowhere}));
  EXPECT_EQ(unwritable.exit_code, 3);
  EXPECT_TRUE(contains(unwritable.err, nowhere)) << unwritable.err;
  EXPECT_EQ(folder.entries(), 1u);
}

}  // namespace
}  // namespace opaline
