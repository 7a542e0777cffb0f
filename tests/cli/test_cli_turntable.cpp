// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline turntable`, and movies of frames by ffmpeg.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> turn(const SceneFolder& folder, const std::string& output,
                              const std::vector<std::string>& more = {}) {
  std::vector<std::string> line{"turntable", folder.scene, "-o",     folder.file(output),
                                "--frames",  "4",          "--quiet"};
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

/// PATH with a program ffmpeg in front, or with nothing else, until the end of the scope.
class Ffmpeg {
 public:
  Ffmpeg(const SceneFolder& folder, const std::string& script) : before_(std::getenv("PATH")) {
    const std::string programs = folder.file("programs");
    fs::create_directory(programs);
    if (!script.empty()) {
      put_bytes(programs + "/ffmpeg", "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\n" + script);
      fs::permissions(programs + "/ffmpeg", fs::perms::owner_all);
    }
    ::setenv("PATH", (script.empty() ? programs : programs + ':' + before_).c_str(), 1);
  }
  ~Ffmpeg() { ::setenv("PATH", before_.c_str(), 1); }
  Ffmpeg(const Ffmpeg&) = delete;
  Ffmpeg& operator=(const Ffmpeg&) = delete;

 private:
  std::string before_;
};

/// The list of frames as the movie.
const std::string kListFrames = "for last; do :; done\ncp frames.txt \"$last\"\n";

// Claim: the camera circles look_at about `up`, counter-clockwise seen from above, from the scene's own position on. By hand: from (0, 0, 50) about +y
// a quarter of the turn is (50, 0, 0). Source: the help of turntable. Tolerance: the rounding of half precision. Fails if: the turn is
// clockwise, or begins one step on.
TEST(CliTurntable, CirclesTheScene) {
  const SceneFolder folder;
  ASSERT_EQ(run_program(turn(folder, "turn.##.exr")).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder.file("turn.05.exr")));
  const std::vector<std::string> positions{"[0,0,50]", "[50,0,0]", "[0,0,-50]", "[-50,0,0]"};
  for (std::size_t frame = 0; frame < 4; ++frame) {
    const std::string one = folder.file("one.exr");
    ASSERT_EQ(run_program({"render", folder.scene, "-o", one, "--quiet", "--set",
                           "camera.position=" + positions[frame]})
                  .exit_code,
              0);
    const auto a = read_image(folder.file("turn.0" + std::to_string(frame + 1) + ".exr")).pixels,
               b = read_image(one).pixels;
    ASSERT_EQ(a.size(), b.size());
    const float most = *std::ranges::max_element(b);
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], .01f * most) << positions[frame];
  }
}

// Claim: ffmpeg gets all frames, the movie appears when it is whole, and the folder of its frames goes. After a failure the old movie
// and the frames stay, and the same command uses them. Source: the help of turntable. Fails if: half a movie stands in the place of
// the old one, or frames are rendered again.
TEST(CliTurntable, MoviesAreWholeOrOld) {
  const SceneFolder folder;
  const std::string movie = folder.file("turn.mp4"), frames = movie + ".frames";
  put_bytes(movie, "old");
  {
    const Ffmpeg broken(folder, "for last; do :; done\necho half > \"$last\"; echo no codec >&2; exit 1\n");
    const Outcome failed = run_program(turn(folder, "turn.mp4"));
    EXPECT_EQ(failed.exit_code, 3);
    EXPECT_TRUE(contains(failed.err, "ffmpeg failed; the frames are in " + frames)) << failed.err;
    EXPECT_TRUE(contains(failed.err, "no codec")) << failed.err;
  }
  EXPECT_EQ(bytes_of(movie), "old");
  const auto time = fs::last_write_time(frames + "/frame.000003.png");
  const Ffmpeg working(folder, "ls -l --time-style=+%s.%N \"" + frames + "\" > \"" + folder.file("times") +
                                   "\"\n" + kListFrames);
  const Outcome done = run_program(turn(folder, "turn.mp4", {"--fps", "12"}));
  EXPECT_EQ(done.exit_code, 0) << done.err;
  for (const char* name : {"frame.000001.png", "frame.000004.png"})
    EXPECT_TRUE(contains(bytes_of(movie), name)) << bytes_of(movie);
  EXPECT_FALSE(fs::exists(frames));
  const auto nanoseconds = std::chrono::duration_cast<std::chrono::nanoseconds>(
                               std::chrono::file_clock::to_sys(time).time_since_epoch())
                               .count();
  EXPECT_TRUE(contains(bytes_of(folder.file("times")), std::to_string(nanoseconds % 1'000'000'000)));
}

// Claim: other files in the folder of the frames stay, and frames of another range are no part of the movie; a name with characters
// of patterns and protocols is one. Fails if: the folder is removed whole, or all that lies in it is encoded.
TEST(CliTurntable, FoldersKeepOtherFiles) {
  const SceneFolder folder;
  const std::string frames = folder.file("a[1]:b.mp4.frames");
  fs::create_directory(frames);
  for (const char* name : {"/notes.txt", "/frame.000009.png"}) put_bytes(frames + name, "mine");
  const Ffmpeg working(folder, kListFrames);
  const Outcome done = run_program(turn(folder, "a[1]:b.mp4"));
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const std::string movie = bytes_of(folder.file("a[1]:b.mp4"));
  EXPECT_TRUE(contains(movie, "frame.000004.png") && !contains(movie, "frame.000009.png")) << movie;
  EXPECT_EQ(bytes_of(frames + "/notes.txt"), "mine");
  EXPECT_FALSE(fs::exists(frames + "/frame.000001.png"));
}

// Claim: `render --frames` writes movies, too; without ffmpeg nothing is rendered, and the message names the program and the other way.
// Fails if: minutes of work end at a missing program.
TEST(CliTurntable, MoviesNeedFfmpeg) {
  const SceneFolder folder;
  const std::vector<std::string> line{"render",   folder.scene, "-o",     folder.file("a.mp4"),
                                      "--frames", "1-2",        "--quiet"};
  {
    const Ffmpeg missing(folder, "");
    const Outcome refused = run_program(line);
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_TRUE(contains(refused.err, "requires the program ffmpeg")) << refused.err;
    EXPECT_TRUE(contains(refused.err, "out.####.png")) << refused.err;
    EXPECT_FALSE(fs::exists(folder.file("a.mp4.frames")));
  }
  const Ffmpeg working(folder, kListFrames);
  EXPECT_EQ(run_program(line).exit_code, 0);
  EXPECT_TRUE(contains(bytes_of(folder.file("a.mp4")), "frame.000002.png"));
}

// Claim: a movie of one image, with a frame's number in its name, or twice, and a rate without a movie, are bad input. Source: the help.
TEST(CliTurntable, MistakesAreNamed) {
  const SceneFolder folder;
  const Ffmpeg working(folder, kListFrames);
  const auto complaint = [&](const std::vector<std::string>& more) {
    std::vector<std::string> line{"render", folder.scene};
    line.insert(line.end(), more.begin(), more.end());
    const Outcome refused = run_program(line);
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    return refused.err;
  };
  EXPECT_EQ(run_program({"render", folder.file("none.json"), "-o", folder.file("a.mp4"), "--frames", "1-2"})
                .exit_code,
            2);
  EXPECT_FALSE(fs::exists(folder.file("a.mp4.frames")));
  EXPECT_TRUE(contains(complaint({"-o", "a.mp4"}), "a movie requires several frames"));
  EXPECT_TRUE(contains(complaint({"-o", "a.##.mp4", "--frames", "1-2"}), "a name without ##"));
  EXPECT_TRUE(contains(complaint({"-o", "a.mp4", "-o", "b.mp4", "--frames", "1-2"}), "more than one movie"));
  EXPECT_TRUE(contains(complaint({"-o", "a.png", "--fps", "12"}), "--fps has no effect"));
}

}  // namespace
}  // namespace opaline
