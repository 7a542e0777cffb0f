// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline render --frames`: a range in one process, in several, and started again.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

/// A blob that bends from frame to frame, a mesh file each, under a light that moves; 6 frames.
struct Shot : SceneFolder {
  static constexpr int kFrames = 6;

  Shot() {
    for (int frame = 1; frame <= kFrames; ++frame) put_bytes(mesh(frame), bent_ball(.004 * frame));
    put_bytes(scene, R"({
  "media": {"marble": {"preset": "marble"}},
  "shapes": [{"name": "blob", "file": "blob.##.obj", "medium": "marble"}],
  "lights": [{"name": "key", "type": "point", "intensity": 1000,
              "position": {"keyed": {"1": [20, 30, 40], "6": [0, 30, 50]}, "between": "spline"}}],
  "camera": {"position": {"keyed": {"1": [0, 0, 50], "6": [10, 0, 50]}}},
  "film": {"resolution": [24, 24]},
  "settings": {"method": "hierarchical", "samples": 800}
}
)");
  }
  std::string mesh(int frame) const { return file("blob.0" + std::to_string(frame) + ".obj"); }
  std::string picture(int frame, const std::string& name = "out") const {
    return file(name + ".000" + std::to_string(frame) + ".exr");
  }

  Outcome render(const std::string& frames, const std::string& name = "out",
                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"render",   scene,  "-o",    file(name + ".####.exr"),
                                   "--frames", frames, "--log", "json"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }

  /// Bytes of all pictures of that name, frame by frame.
  std::vector<std::string> pictures(const std::string& name) const {
    std::vector<std::string> bytes;
    for (int frame = 1; frame <= kFrames; ++frame) bytes.push_back(bytes_of(picture(frame, name)));
    return bytes;
  }

 private:
  static std::string bent_ball(double bend) {
    std::string text;
    constexpr int kRings = 12, kSides = 16;
    for (int r = 0; r <= kRings; ++r)
      for (int s = 0; s < kSides; ++s) {
        const double a = M_PI * r / kRings, b = 2 * M_PI * s / kSides, y = 10 * std::cos(a);
        text += "v " + std::to_string(10 * std::sin(a) * std::cos(b) + bend * y * y) + ' ' +
                std::to_string(y) + ' ' + std::to_string(10 * std::sin(a) * std::sin(b)) + '\n';
      }
    for (int r = 0; r < kRings; ++r)
      for (int s = 0; s < kSides; ++s) {
        const int a = 1 + r * kSides + s, b = 1 + r * kSides + (s + 1) % kSides;
        const auto face = [&](int p, int q, int t) {
          text += "f " + std::to_string(p) + ' ' + std::to_string(q) + ' ' + std::to_string(t) + '\n';
        };
        face(a, b, a + kSides);
        face(b, b + kSides, a + kSides);
      }
    return text;
  }
};

std::string command_of(const std::string& path) {
  for (const auto& [name, value] : read_image(path).metadata)
    if (name == "opaline:command") return value;
  return {};
}

// Claim: --target-error chooses once, by the reference frame, for all frames: they share their settings, a
// frame of another process has the same bytes, and what is there is left alone. Source: quality.h. Fails if:
// settings are chosen by the frame itself, or by the first of those asked for.
TEST(CliFrames, TargetErrorIsChosenOnce) {
  const Shot shot;
  const std::vector<std::string> target{"--target-error", ".1%"};
  const Outcome all = shot.render("1-6", "all", target);
  ASSERT_EQ(all.exit_code, 0) << all.err;
  const std::string command = command_of(shot.picture(1, "all"));
  EXPECT_TRUE(contains(command, "--set settings.samples=") && !contains(command, "--target-error"))
      << command;
  std::size_t targets = 0;
  for (const nlohmann::json& event : events_of(all.out)) targets += event["event"] == "target" ? 1 : 0;
  EXPECT_EQ(targets, 1u);
  ASSERT_EQ(shot.render("6", "one", target).exit_code, 0);
  EXPECT_TRUE(bytes_of(shot.picture(6, "one")) == bytes_of(shot.picture(6, "all")));
  EXPECT_EQ(command_of(shot.picture(6, "all")), command);
  const std::string again_by = event_of(events_of(all.out), "again_by")["command"];
  EXPECT_TRUE(again_by.ends_with(" --frames 1-6")) << again_by;
  ASSERT_EQ(std::system((again_by + " --quiet").c_str()), 0);
  EXPECT_TRUE(bytes_of(shot.picture(6, "one")) == bytes_of(shot.picture(6, "all")));
  const Outcome again = shot.render("1-6", "all", target);
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_TRUE(contains(again.out, R"("event":"skipped")")) << again.out;
  EXPECT_FALSE(contains(again.out, R"("event":"done")")) << again.out;
}

std::vector<std::string> decisions_of(const Outcome& outcome) {
  std::vector<std::string> all;
  for (const nlohmann::json& event : events_of(outcome.out))
    if (event["event"] == "reuse")
      for (const std::string line : event["decisions"]) all.push_back(line);
  return all;
}

// Claim: a frame's bytes are the same from one process for all, from one for each in any order, and with a
// cache that others filled. Source: session.h, anchor. Fails if: a frame's samples are carried from the last.
TEST(CliFrames, AnyProcessAnyOrder) {
  const Shot shot;
  ASSERT_EQ(shot.render("1-6", "one").exit_code, 0);
  const std::vector<std::string> expected = shot.pictures("one");
  for (const std::string& bytes : expected) EXPECT_FALSE(bytes.empty());
  EXPECT_NE(expected[0], expected[1]);
  for (const char* frame : {"4", "1", "6", "2,3", "5"}) ASSERT_EQ(shot.render(frame, "each").exit_code, 0);
  EXPECT_TRUE(shot.pictures("each") == expected);
  const std::vector<std::string> cache{"--cache", shot.file("cache")};
  ASSERT_EQ(
      run_program({"precompute", shot.scene, "--cache", cache[1], "--frames", "1-6", "--quiet"}).exit_code,
      0);
  const Outcome cached = shot.render("1-6", "cached", cache);
  ASSERT_EQ(cached.exit_code, 0) << cached.out;
  EXPECT_TRUE(shot.pictures("cached") == expected);
  for (const std::string& line : decisions_of(cached))
    EXPECT_TRUE(line.ends_with("from the cache") || line.ends_with("reused")) << line;
}

// Claim: where only the camera moves the exitance of the surface is evaluated once, in whichever frame comes
// first, and a frame's bytes do not depend on which others its process renders, nor on a cache that
// `precompute` filled. Source: Scene::camera_frames. Fails if: the number of frames asked for decides.
TEST(CliFrames, CameraAlone) {
  const Shot shot;
  const std::vector<std::string> still{
      "--set", "lights.key.position=[20, 30, 40]",
      "--set", "shapes.blob.file=blob.01.obj",
      "--set", "media.marble.profile=dipole",  // smooth enough for a cache of 800 samples
      "--set", "film.resolution=[64,64]",      // many enough for one
      "--set", R"(camera.position={"keyed": {"1": [0, 0, 50], "96": [50, 0, 0]}})"};
  const Outcome all = shot.render("1-6", "all", still);
  ASSERT_EQ(all.exit_code, 0) << all.out;
  const std::vector<std::string> decisions = decisions_of(all);
  EXPECT_EQ(std::ranges::count_if(decisions, [](auto& d) { return d.ends_with("surface evaluated"); }), 1);
  EXPECT_EQ(std::ranges::count_if(decisions, [](auto& d) { return d.ends_with("surface reused"); }), 5);
  std::vector<std::string> fill{"precompute", shot.scene, "--cache", shot.file("cache"),
                                "--frames",   "2",        "--quiet"};
  fill.insert(fill.end(), still.begin(), still.end());
  ASSERT_EQ(run_program(fill).exit_code, 0);
  std::vector<std::string> cached = still;
  cached.insert(cached.end(), {"--cache", shot.file("cache")});
  for (const char* frame : {"4", "1", "6", "2,3", "5"})
    for (const std::string& line : decisions_of(shot.render(frame, "each", cached)))
      EXPECT_TRUE(line.ends_with("from the cache") || line.ends_with("reused")) << line;
  EXPECT_TRUE(shot.pictures("each") == shot.pictures("all"));
}

// Claim: frames that are there are left alone, those that something else made are not: another scene value,
// another mesh, another frame's picture, half a file. Source: frames.h. Fails if: existence is enough.
TEST(CliFrames, Resumes) {
  const Shot shot;
  ASSERT_EQ(shot.render("1-3").exit_code, 0);
  const auto rendered = [&](const std::string& frames, const std::vector<std::string>& more = {}) {
    const Outcome outcome = shot.render(frames, "out", more);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    std::size_t count = 0;
    for (const nlohmann::json& event : events_of(outcome.out)) count += event["event"] == "done";
    return count;
  };
  EXPECT_EQ(rendered("1-4"), 1u);
  EXPECT_EQ(rendered("1-4"), 0u);
  EXPECT_EQ(rendered("1-4", {"--set", "media.marble.specular_ior=1.4"}), 4u);
  EXPECT_EQ(rendered("1-4"), 4u);
  std::filesystem::copy_file(shot.mesh(5), shot.mesh(2), std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(rendered("1-4"), 1u);
  std::filesystem::copy_file(shot.picture(1), shot.picture(2),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(rendered("1-4"), 1u);
  put_bytes(shot.picture(3), bytes_of(shot.picture(3)).substr(0, 500));
  EXPECT_EQ(rendered("1-4"), 1u);
}

// Claim: so it is with PNG files alone, which say the same of themselves. Source: frames.h. Fails if: their text is not
// written, or only an EXR is believed.
TEST(CliFrames, ResumesPictures) {
  const SceneFolder folder;
  const auto rendered = [&](const std::vector<std::string>& more = {}) {
    std::vector<std::string> line{"render",   folder.scene, "-o",       folder.file("a.##.png"),
                                  "--frames", "1-2",        "--method", "lambert",
                                  "--log",    "json"};
    line.insert(line.end(), more.begin(), more.end());
    std::size_t count = 0;
    for (const nlohmann::json& event : events_of(run_program(line).out)) count += event["event"] == "done";
    return count;
  };
  EXPECT_EQ(rendered(), 2u);
  EXPECT_EQ(rendered(), 0u);
  EXPECT_EQ(rendered({"--seed", "7"}), 2u);
  put_bytes(folder.file("a.01.png"), bytes_of(folder.file("a.01.png")).substr(0, 300));
  EXPECT_EQ(rendered({"--seed", "7"}), 1u);
}

// Claim: a bad frame is named, the others are rendered, and the exit code is 3. Source: the help of render.
// Fails if:
// the first failure ends the run, or is forgotten.
TEST(CliFrames, OneBadFrame) {
  const Shot shot;
  put_bytes(shot.mesh(3), "v 0 0 nan\n");
  std::filesystem::remove(shot.mesh(5));
  const Outcome outcome = shot.render("1-6");
  EXPECT_EQ(outcome.exit_code, 3);
  const std::string message = event_of(events_of(outcome.out), "error")["message"];
  EXPECT_TRUE(contains(message, "2 of 6 frames failed: 3, 5")) << message;
  for (int frame = 1; frame <= 6; ++frame)
    EXPECT_EQ(std::filesystem::exists(shot.picture(frame)), frame != 3 && frame != 5) << frame;
}

// Claim: ranges that are none, and names that all frames would share, are exit 2 before the work. Source:
// `opaline render --help`. Fails if: 5-1 is taken for nothing to do.
TEST(CliFrames, Mistakes) {
  const Shot shot;
  for (const char* frames : {"", "5-1", "1-", "a", "-3", "1-4x0", "1,", "1-999999999"})
    EXPECT_EQ(shot.render(frames).exit_code, 2) << frames;
  EXPECT_EQ(run_program({"render", shot.scene, "-o", shot.file("a.exr"), "--frames", "1-2"}).exit_code, 2);
  EXPECT_EQ(run_program({"precompute", shot.scene, "--frames", "1-2"}).exit_code, 2);
}

// Claim: a single frame needs no place for its number. Fails if: names are asked for it that it would not share.
TEST(CliFrames, OneFrameUnderAnyName) {
  const Shot shot;
  ASSERT_EQ(shot.render("2").exit_code, 0);
  const Outcome alone = run_program({"render", shot.scene, "-o", shot.file("a.exr"), "--frames", "2"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_TRUE(read_image(shot.file("a.exr")).pixels == read_image(shot.picture(2)).pixels);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// Claim: frames print their plan once, and of later frames the paragraphs that differ. Source: print_plan. Fails if: each
// frame prints all of it.
TEST(CliFrames, PlanIsPrintedOnce) {
  const Shot shot;
  const auto text_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", shot.scene, "-o", shot.file("a.##.exr"), "--frames", "1-3"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words).out;
  };
  const std::string bent = text_of({});
  EXPECT_EQ(count_of(bent, "\nframe "), 3u) << bent;
  EXPECT_EQ(count_of(bent, "\nlights "), 1u) << bent;
  EXPECT_EQ(count_of(bent, "\ntranslucent "), 3u) << bent;  // three areas
  const std::string still = text_of({"--set", "shapes.blob.file=blob.01.obj"});
  EXPECT_EQ(count_of(still, "\ntranslucent "), 1u) << still;
}

/// Runs a script of scenes/ with the program under test.
int run_script(const std::string& variables, const std::string& script, const std::string& words) {
  const std::string command = "OPALINE='" OPALINE_PROGRAM "' " + variables + ' ' + OPALINE_SCENES_DIR + '/' +
                              script + ' ' + words + " >&2";
  return std::system(command.c_str());
}

// Claim: the scripts for GNU parallel and Slurm render a shot to the same bytes as one process; the array's
// tasks are started as Slurm does, with its variables. Source: the scripts' first lines. Fails if: a word of
// their command is no longer an option.
TEST(CliFrames, Scripts) {
  const Shot shot;
  ASSERT_EQ(shot.render("1-6", "one").exit_code, 0);
  const auto words = [&](const std::string& name) {
    return shot.scene + ' ' + shot.file(name + ".####.exr") + ' ' + shot.file(name + "-cache");
  };
  ASSERT_EQ(run_script("", "frames-parallel", "3 1-6 " + words("parallel")), 0);
  EXPECT_TRUE(shot.pictures("parallel") == shot.pictures("one"));
  for (int task = 1; task <= 6; ++task)
    ASSERT_EQ(run_script("SLURM_CPUS_PER_TASK=1 SLURM_ARRAY_TASK_ID=" + std::to_string(task), "frames.sbatch",
                         words("slurm")),
              0);
  EXPECT_TRUE(shot.pictures("slurm") == shot.pictures("one"));
  EXPECT_NE(run_script("", "frames.sbatch", words("slurm")), 0);
  EXPECT_NE(run_script("", "frames-parallel", ""), 0);
}

// Claim: frames.sbatch finds the program of its clone where Slurm runs a copy of it, and frames-parallel names the frames that
// failed. `scontrol` here prints what Slurm 22.05 does. Source: the scripts. Fails if: the copy's own folder is looked at,
// or the failed frames' numbers are lost.
TEST(CliFrames, ScriptsInOtherPlaces) {
  const Shot shot;
  namespace fs = std::filesystem;
  const fs::path clone = shot.path / "a clone";
  fs::create_directories(clone / "scenes");
  fs::create_directories(clone / "build/src");
  fs::create_directories(shot.path / "spool");
  for (const char* script : {"frames.sbatch", "find-program"})
    fs::copy_file(OPALINE_SCENES_DIR / fs::path(script), clone / "scenes" / script);
  fs::copy_file(OPALINE_SCENES_DIR "/frames.sbatch", shot.path / "spool/slurm_script");
  fs::create_symlink(OPALINE_PROGRAM, clone / "build/src/opaline");
  put_bytes(shot.file("spool/scontrol"), "#!/bin/sh\necho 'JobId=7 JobName=opaline'\necho '   Command=" +
                                             (clone / "scenes/frames.sbatch").string() + " a.json b c'\n");
  fs::permissions(shot.file("spool/scontrol"), fs::perms::owner_all);
  const std::string slurm = "SLURM_JOB_ID=7 SLURM_ARRAY_TASK_ID=2 PATH=" + shot.file("spool") + ":$PATH " +
                            shot.file("spool/slurm_script") + ' ';
  EXPECT_EQ(std::system(
                (slurm + shot.scene + ' ' + shot.file("slurm.####.exr") + ' ' + shot.file("cache")).c_str()),
            0);
  EXPECT_TRUE(fs::exists(shot.picture(2, "slurm")));

  fs::remove(shot.mesh(3));
  const std::string words = "2 1-4 " + shot.scene + ' ' + shot.file("p.####.exr") + ' ' + shot.file("cache") +
                            " 2>" + shot.file("err");
  EXPECT_NE(run_script("", "frames-parallel", words), 0);
  EXPECT_TRUE(contains(bytes_of(shot.file("err")), "failed frames: 3;")) << bytes_of(shot.file("err"));
}

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

// Claim: the options of frames-parallel that change the scene reach the process that fills the cache, too: it
// holds what one process keeps with them, and nothing else. Source: the script. Fails if: precompute is
// started without them.
TEST(CliFrames, ScriptPassesOptionsOn) {
  const Shot shot;
  ASSERT_EQ(shot.render("1-2", "one",
                        {"--cache", shot.file("one-cache"), "--seed", "3", "--set", "settings.samples=700",
                         "--set=media.marble.specular_ior=1.4"})
                .exit_code,
            0);
  ASSERT_EQ(run_script("", "frames-parallel",
                       "1 1-2 " + shot.scene + ' ' + shot.file("parallel.####.exr") + ' ' +
                           shot.file("parallel-cache") +
                           " --seed 3 --set settings.samples=700 --set=media.marble.specular_ior=1.4"),
            0);
  EXPECT_EQ(names_in(shot.file("parallel-cache")), names_in(shot.file("one-cache")));
  for (const int frame : {1, 2})
    EXPECT_TRUE(bytes_of(shot.picture(frame, "parallel")) == bytes_of(shot.picture(frame, "one"))) << frame;
}

}  // namespace
}  // namespace opaline
