// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline render --write-partial` and `--display-server`: pictures before the picture.
#include <algorithm>

#include "opaline/image/image.h"
#include "run_program.h"
#include "viewer.h"

namespace opaline {
namespace {

struct PartialScene : SceneFolder {
  std::string exr = file("ball.exr"), png = file("ball.png");

  std::vector<std::string> command(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"render",       scene,  "-o", exr, "--set", "film.pixel_type=float",
                                   "--resolution", "70x50"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  Outcome render(const std::vector<std::string>& more) const { return run_program(command(more)); }
};

/// R G B A of a picture's file.
std::vector<float> shown_channels(const std::string& path) {
  const Image image = read_image(path);
  std::vector<std::size_t> places;
  for (const char* name : {"R", "G", "B", "A"})
    places.push_back(std::size_t(std::ranges::find(image.channels, name) - image.channels.begin()));
  std::vector<float> values;
  for (std::size_t at = 0; at < image.pixels.size(); at += image.channels.size())
    for (const std::size_t place : places) values.push_back(image.pixels[at + place]);
  return values;
}

std::string partial_stage(const std::string& path) {
  for (const auto& [key, value] : read_image(path).metadata)
    if (key == "opaline:partial") return value;
  return {};
}

/// What the log says when a stage has ended.
std::string ended(const std::string& stage) {
  return R"({"event":"stage","stage":")" + stage + '"';
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += double(value);
  return sum / double(values.size());
}

// Claim: with partial pictures and a viewer the files' bytes are those without. The viewer has the picture
// created once, then two coarse ones of nearly the brightness of the last, then tiles, and in the end what
// the file holds. Source: the help of render; tev's protocol as its src/Ipc.cpp reads it. Fails if: a
// packet's length leaves itself out; the last tiles are not sent; the refinement changes what is rendered.
TEST(CliPartial, ViewerEndsWithThePicture) {
  const PartialScene ball;
  ASSERT_EQ(ball.render({"-o", ball.png}).exit_code, 0);
  const std::string exr = bytes_of(ball.exr), png = bytes_of(ball.png);
  Viewer viewer;
  const Outcome outcome =
      ball.render({"-o", ball.png, "--write-partial", "--display-server", viewer.address()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_FALSE(contains(outcome.err, "warning")) << outcome.err;
  EXPECT_TRUE(bytes_of(ball.exr) == exr);
  EXPECT_TRUE(bytes_of(ball.png) == png);

  const auto pictures = shown_by(viewer.stream());
  ASSERT_EQ(pictures.size(), 1u);
  const auto& [name, picture] = *pictures.begin();
  EXPECT_EQ(name, ball.exr);
  EXPECT_EQ(picture.width, 70);
  EXPECT_EQ(picture.height, 50);
  EXPECT_EQ(picture.creations, 1);
  EXPECT_EQ(picture.tiles, 5 * 4);
  const std::vector<float> last = shown_channels(ball.exr);
  EXPECT_TRUE(picture.pixels == last);
  ASSERT_EQ(picture.whole.size(), 2u);
  for (const std::vector<float>& coarse : picture.whole) EXPECT_NEAR(mean(coarse) / mean(last), 1, .1);
  EXPECT_NE(picture.whole[0], picture.whole[1]);
}

// Claim: a crop's pixels lie where the file has them; each frame has a picture of its own. Source: the help
// of render.
// Fails if: a tile's place is that in the whole picture.
TEST(CliPartial, CropAndFrames) {
  const PartialScene ball;
  Viewer viewer;
  const std::string out = ball.file("out.##.exr");
  ASSERT_EQ(run_program({"render", ball.scene, "-o", out, "--frames", "1-2", "--set", "film.pixel_type=float",
                         "--crop", "5,7,30,20", "--display-server", viewer.address()})
                .exit_code,
            0);
  const auto pictures = shown_by(viewer.stream());
  EXPECT_EQ(pictures.size(), 2u);
  for (const auto& [name, picture] : pictures) {
    EXPECT_EQ(picture.width, 25);
    EXPECT_TRUE(picture.pixels == shown_channels(name)) << name;
  }
}

// Claim: an interrupted run with --write-partial leaves a whole picture that says what it is, in each output,
// and nothing else; without the option the old file stays. A frame of a range is not taken for done by it.
// Source: `opaline render --help`. Fails if: partial pictures are not written; they say what a frame does.
TEST(CliPartial, Interrupted) {
  const PartialScene ball;
  const std::vector<std::string> endless{"--method", "direct", "--entry-samples", "100000000",
                                         "-o",       ball.png, "--log",           "json"};
  for (const bool partial : {false, true}) {
    put_bytes(ball.exr, "old");
    put_bytes(ball.png, "old");
    std::vector<std::string> words = endless;
    if (partial) words.push_back("--write-partial");
    Child child(ball.command(words));
    ASSERT_TRUE(child.prints(ended(partial ? "first light" : "rays")));
    child.send(SIGINT);
    const Outcome outcome = child.wait();
    EXPECT_EQ(outcome.exit_code, 130);
    EXPECT_EQ(contains(outcome.out, "; what was done is in " + ball.exr), partial) << outcome.out;
    EXPECT_EQ(bytes_of(ball.exr) == "old", !partial);
    EXPECT_EQ(bytes_of(ball.png) == "old", !partial);
  }
  EXPECT_EQ(partial_stage(ball.exr), "first light");
  EXPECT_EQ(shown_channels(ball.exr).size(), 70u * 50 * 4);
  EXPECT_EQ(read_image(ball.png).width, 70);
  EXPECT_EQ(ball.entries(), 3u);
}

// Claim: partial files are refined: after the first light one with all samples, then tiles, while a frame of
// a range that has but them is rendered. Source: partial_picture.h. Fails if: a partial picture has the
// metadata of the frame.
TEST(CliPartial, FrameIsNotDone) {
  const PartialScene ball;
  const std::string out = ball.file("out.1.exr");
  const std::vector<std::string> words{"render",    ball.scene, "-o",    ball.file("out.##.exr"),
                                       "--frames",  "1",        "--spp", "1500",
                                       "--threads", "1",        "--log", "json"};
  std::vector<std::string> partial = words;
  partial.push_back("--write-partial");
  {
    Child child(partial);
    ASSERT_TRUE(child.prints(ended("refinement")));
    child.send(SIGINT);
    ASSERT_EQ(child.wait().exit_code, 130);
  }
  EXPECT_EQ(partial_stage(ball.file("out.01.exr")), "refinement");
  const Outcome again = run_program(words);
  EXPECT_EQ(again.exit_code, 0);
  event_of(events_of(again.out), "done");
  EXPECT_EQ(partial_stage(ball.file("out.01.exr")), "");
}

// Claim: while a long picture is under way the file has the tiles that are done. Source: `opaline render
// --help`. Fails if: only coarse pictures are written.
TEST(LongCliPartial, TilesAreWritten) {
  const PartialScene ball;
  Child child(ball.command(
      {"--spp", "40000", "--evaluator", "dual_tree", "--threads", "1", "--write-partial", "--log", "json"}));
  ASSERT_TRUE(child.prints(ended("refinement")));
  for (int i = 0; i < 600 && partial_stage(ball.exr) != "tiles"; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(partial_stage(ball.exr), "tiles");
  child.send(SIGINT);
  EXPECT_EQ(child.wait().exit_code, 130);
}

// Claim: a viewer that is not there, or goes away, is one warning, and the picture is the same. Source: the
// issue. Fails if: a failed connection ends the run; each packet warns; SIGPIPE kills.
TEST(CliPartial, ViewerGone) {
  const PartialScene ball;
  ASSERT_EQ(ball.render({}).exit_code, 0);
  const std::string bytes = bytes_of(ball.exr);
  const auto warnings = [&](const std::string& address) {
    const Outcome outcome = ball.render({"--display-server", address, "--log", "json"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    EXPECT_TRUE(bytes_of(ball.exr) == bytes);
    std::size_t count = 0;
    for (const nlohmann::json& event : events_of(outcome.out))
      if (event["event"] == "warning") {
        EXPECT_TRUE(contains(event["message"], address)) << event;
        ++count;
      }
    return count;
  };
  Viewer leaves(1);
  EXPECT_EQ(warnings(leaves.address()), 1u);
  leaves.stream();
  std::string nobody;
  {
    Viewer closed(1);
    nobody = closed.address();
  }
  EXPECT_EQ(warnings(nobody), 1u);
}

// Claim: a viewer that reads 4 KB/s is dropped with one warning before it has had the 12 MB of a picture,
// which would take it most of an hour; the picture is made. Tolerance: a minute and a half, on a busy
// machine; alone it takes 8 s. Fails if: patience is counted anew for each send.
TEST(CliPartial, SlowViewer) {
  const PartialScene ball;
  const Viewer viewer(SIZE_MAX, std::chrono::milliseconds(100));
  Child child({"render", ball.scene, "-o", ball.exr, "--resolution", "512x512", "--display-server",
               viewer.address(), "--log", "json"});
  const Outcome outcome = child.wait(90);
  EXPECT_EQ(outcome.exit_code, 0) << "signal " << outcome.signal;
  EXPECT_TRUE(contains(event_of(events_of(outcome.out), "warning")["message"], "too slow")) << outcome.out;
}

// Claim: an address that is none is exit 2 and says what is expected. Source: `opaline render --help`. Fails
// if: a port is cut to 16 bits.
TEST(CliPartial, Mistakes) {
  const PartialScene ball;
  for (const char* address :
       {"", ":14158", "host:", "host:0", "host:65536", "host:14158x", "host:-1", "a:b:1", "a b:1", "[::1"}) {
    const Outcome outcome = ball.render({"--display-server", address});
    EXPECT_EQ(outcome.exit_code, 2) << address;
    EXPECT_TRUE(contains(outcome.err, "HOST:PORT")) << outcome.err;
  }
  EXPECT_FALSE(std::filesystem::exists(ball.exr));
}

}  // namespace
}  // namespace opaline
