// SPDX-License-Identifier: GPL-3.0-or-later
// Runs that end early: what is said, the exit code, and that the folder is as it was.
#include <gtest/gtest.h>

#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

// Claim: bad scenes are exit 2 with file and line, and nothing is written. Source: the design. Fails if: main
// maps Error to another code.
TEST(CliFailures, BadScenes) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr"), scene = folder.file("bad.json");
  const struct {
    std::string text, said;
  } cases[] = {
      {"", "empty"},
      {"\xff\xfe{", "bad.json: is UTF-16"},
      {"{\n\"film\": {\"resolutoin\": [2, 2]}}", "bad.json:2:10: "},
      {"{\"shapes\": [\n{\"file\": \"missing.ply\"}]}", "missing.ply: no such mesh file"},
      {"{\"shapes\": [\n{\"file\": \"missing.ply\"}]}", "bad.json:2:10: "},
  };
  for (const auto& c : cases) {
    put_bytes(scene, c.text);
    const Outcome outcome = run_program({"render", scene, "-o", out, "--quiet"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_TRUE(contains(outcome.err, c.said)) << outcome.err;
    EXPECT_EQ(folder.entries(), 2u);
  }
  EXPECT_EQ(run_program({"render", folder.file("none.json"), "-o", out}).exit_code, 2);
}

// Claim: with a JSON log an error is an event with its place, and stderr is empty.
// Source: log.h. Fails if: print_failure writes text as well.
TEST(CliFailures, ErrorsAsEvents) {
  const SceneFolder folder;
  put_bytes(folder.scene, "{\n\"film\": {\"resolutoin\": [2, 2]}}");
  const Outcome outcome = run_program({"render", folder.scene, "-o", folder.file("a.exr"), "--log", "json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(outcome.err.empty()) << outcome.err;
  const nlohmann::json error = event_of(events_of(outcome.out), "error");
  EXPECT_EQ(error["kind"], "bad_input");
  EXPECT_EQ(error["exit_code"], 2);
  EXPECT_EQ(error["file"], folder.scene);
  EXPECT_EQ(error["line"], 2);
  const Outcome option = run_program({"render", folder.scene, "--log", "json", "--spps", "4"});
  EXPECT_TRUE(option.err.empty()) << option.err;
  EXPECT_TRUE(contains(event_of(events_of(option.out), "error")["message"].get<std::string>(), "'--spp'"));
}

// Claim: an output that cannot be written is said before the work, exit 3: the scene is not even read.
// Source: commands.h. Fails if: the check moves behind the loading.
TEST(CliFailures, UnwritableOutputIsSaidAtOnce) {
  const SceneFolder folder;
  std::filesystem::create_directory(folder.file("folder.png"));
  for (const std::string& path : {folder.file("missing/a.exr"), folder.file("folder.png")}) {
    const Outcome outcome =
        run_program({"render", folder.file("none.json"), "-o", folder.file("ok.exr"), "-o", path});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("opaline: error: " + path)) << outcome.err;
    EXPECT_TRUE(outcome.out.empty());
  }
  EXPECT_TRUE(contains(run_program({"render", folder.scene, "-o", "/proc/a.png"}).err,
                       "cannot write in the folder '/proc'"));
  EXPECT_TRUE(
      contains(run_program({"render", folder.scene, "-o", "none/a.png"}).err, "no such folder 'none'"));
  EXPECT_EQ(folder.entries(), 2u);
}

// Claim: a full disk is exit 3, the old file stays, nothing is beside it. Source: atomic_file.h. Fails if: a
// writer does not go through AtomicFile.
TEST(CliFailures, FullDiskKeepsTheOldFile) {
  const SceneFolder folder;
  for (const char* name : {"a.exr", "a.png"}) {
    const std::string out = folder.file(name);
    put_bytes(out, "old");
    const Outcome outcome = run_program(
        {"render", folder.scene, "-o", out, "--quiet", "--resolution", "128x128", "--method", "lambert"}, ".",
        {.file_size = 300, .address_space = {}});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_EQ(bytes_of(out), "old");
    std::filesystem::remove(out);
    EXPECT_EQ(folder.entries(), 1u);
  }
}

#ifndef __SANITIZE_ADDRESS__  // which needs more address space than the limit
// Claim: a picture that memory does not hold is exit 3, "out of memory", with nothing written.
// Source: the design exit codes. Fails if: the plan is not compared with what there is, and std::bad_alloc is
// not told from other exceptions.
TEST(CliFailures, OutOfMemory) {
  const SceneFolder folder;
  const Outcome outcome = run_program({"render", folder.scene, "-o", folder.file("a.exr"), "--quiet",
                                       "--method", "lambert", "--resolution", "16384x16384"},
                                      ".", {.file_size = {}, .address_space = rlim_t(4) << 30});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.signal;
  EXPECT_TRUE(outcome.err.starts_with("opaline: error: out of memory")) << outcome.err;
  EXPECT_EQ(folder.entries(), 1u);
}

// Claim: with any limit of address space, the program renders the image, or ends with exit 3 and leaves the old
// file unchanged; if its libraries cannot be loaded, the system reports it (127). Source: main.cpp. Fails if: an
// exception leaves a library's constructor before main, as at 100 MB, and aborts.
TEST(CliFailures, NoMemoryAbortsNothing) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr");
  for (const rlim_t megabytes : {60, 90, 100, 120, 150, 200, 300, 500}) {
    put_bytes(out, "old");
    const Outcome outcome = run_program({"render", folder.scene, "-o", out, "--quiet"}, ".",
                                        {.file_size = {}, .address_space = megabytes << 20});
    EXPECT_EQ(outcome.signal, 0) << megabytes << outcome.err;
    EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 3 || outcome.exit_code == 127) << outcome.err;
    EXPECT_EQ(bytes_of(out) == "old", outcome.exit_code != 0) << megabytes;
    if (outcome.exit_code == 3) {
      EXPECT_TRUE(outcome.err.starts_with("opaline: error: out of memory")) << outcome.err;
    }
    EXPECT_EQ(folder.entries(), 2u) << megabytes;
  }
}

// Claim: without memory for the libraries that read textures, the program reports "out of memory". Source: main.cpp. Fails
// if: it prints the dynamic loader's message.
TEST(CliFailures, NoMemoryForTheTextureReader) {
  const SceneFolder folder;
  for (const rlim_t megabytes : {200, 250}) {
    const Outcome outcome = run_program({"render", std::string(OPALINE_TEST_INPUTS) + "/grey_alpha.json",
                                         "-o", folder.file("a.exr"), "--quiet"},
                                        ".", {.file_size = {}, .address_space = megabytes << 20});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_EQ(outcome.err, "opaline: error: out of memory\n");
  }
}

// Claim: a picture beyond the memory there is is refused before it is begun, with what would make it fit; a
// crop of as large a one takes as much as the crop, and is made. By hand: 16384 x 16384 pixels of 26 floats
// are 28 GB, above the 4 GB that the child may have. Fails if: the plan counts the pixels outside of the
// crop, or nobody asks how much memory there is.
TEST(CliFailures, TooLargeForTheMemoryIsSaidBeforeItStarts) {
  const SceneFolder folder;
  const Limits limits{{}, rlim_t(4) << 30};
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", folder.scene, "-o", folder.file("a.exr"), "--quiet"});
    return run_program(more, ".", limits);
  };
  const Outcome refused = run({"--resolution", "16384x16384"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_TRUE(contains(refused.err, "out of memory: the image needs about ") &&
              contains(refused.err, "a lower film.resolution"))
      << refused.err;
  EXPECT_EQ(folder.entries(), 1u);
  const Outcome crop = run({"--resolution", "65536x65536", "--crop", "32768,32768,32784,32784"});
  EXPECT_EQ(crop.exit_code, 0) << crop.err;
}
#endif

const std::string kShading = R"({"event":"progress","stage":"shading")";

// Claim: Ctrl-C, and what a batch system sends, end the run soon with 130; the old picture stays, nothing is
// beside it. Source: the design. Fails if: the handler is not installed, or a stage does not look at its
// monitor.
TEST(CliFailures, InterruptKeepsTheOldFile) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const SceneFolder folder;
    const std::string out = folder.file("a.exr");
    put_bytes(out, "old");
    Child child({"render", folder.scene, "-o", out, "--log", "json", "--method", "lambert", "--resolution",
                 "2048x2048", "--spp", "100"});
    ASSERT_TRUE(child.prints(kShading));
    child.send(signal);
    const Outcome outcome = child.wait(20);
    EXPECT_EQ(outcome.exit_code, 130) << "signal " << outcome.signal;
    EXPECT_EQ(event_of(events_of(outcome.out), "error")["kind"], "interrupted");
    EXPECT_EQ(bytes_of(out), "old");
    EXPECT_EQ(folder.entries(), 2u);
  }
}

// Claim: Ctrl-C while the error is measured ends the run soon, and the picture, which is there, is written. Fails if: the
// measurement does not look at its monitor, or the picture is lost.
TEST(CliFailures, InterruptWhileVerifying) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr");
  put_bytes(out, "old");
  Child child({"render", folder.scene, "-o", out, "--log", "json", "--verify", "--resolution", "16x16",
               "--set", "settings.samples=60000"});
  ASSERT_TRUE(child.prints(R"({"event":"progress","stage":"verifying")"));
  child.send(SIGINT);
  const Outcome outcome = child.wait(20);
  EXPECT_EQ(outcome.exit_code, 130) << "signal " << outcome.signal;
  const nlohmann::json error = event_of(events_of(outcome.out), "error");
  EXPECT_EQ(error["kind"], "interrupted");
  EXPECT_TRUE(contains(error["message"].get<std::string>(), "the image is written")) << error.dump();
  EXPECT_EQ(read_image(out).width, 16);
  EXPECT_EQ(folder.entries(), 2u);
}

// Claim: a second Ctrl-C kills at once, whatever the stage does: here one tile of 100 million kernels, in
// which nobody looks at the monitor. Source: interrupt.h. On a loaded machine the first may be heard before
// the tile begins, which ends in 130: three tries. Fails if: the handler stays after the first.
TEST(CliFailures, SecondInterruptKills) {
  const SceneFolder folder;
  Outcome outcome;
  for (int attempt = 0; attempt < 3 && outcome.signal != SIGINT; ++attempt) {
    Child child({"render", folder.scene, "-o", folder.file("a.exr"), "--log", "json", "--evaluator",
                 "brute_force", "--set", "settings.samples=400000", "--resolution", "16x16"});
    ASSERT_TRUE(child.prints(kShading));
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    child.send(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    child.send(SIGINT);
    outcome = child.wait(20);
    EXPECT_EQ(folder.entries(), 1u);
  }
  EXPECT_EQ(outcome.signal, SIGINT) << "exit code " << outcome.exit_code;
}

// Claim: a path of 20,000 parts after --set is refused by its depth. Fails if: a tree that deep is built,
// whose end is as deep a recursion (the program before it: a segmentation fault at some lengths).
TEST(CliFailures, DeepOverrides) {
  const SceneFolder folder;
  for (const std::size_t parts : {65u, 20000u, 60000u}) {
    std::string path = "media";
    for (std::size_t i = 1; i < parts; ++i) path += ".a";
    const Outcome outcome = run_program({"info", folder.scene, "--set", path + "=1"});
    EXPECT_EQ(outcome.exit_code, 2) << parts << " signal " << outcome.signal;
    EXPECT_TRUE(contains(outcome.err, "nested too deeply (expected at most 64 levels")) << outcome.err;
  }
}

// Claim: no output replaces a file that the scene was read from, nor `compare` an image that it compares. Source: outputs and inputs
// of usual names (spot.obj with spot.png). Fails if a texture, one tile of several, an environment or a reference is written over.
TEST(CliFailures, OutputsAreNoInputs) {
  const SceneFolder folder;
  const std::string place = folder.path.string() + "/";
  const auto rendered = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all{
        "render", folder.scene, "--resolution",
        "32x16",  "--set",      R"(shapes.ball={"sphere": {"radius": 10}, "medium": "marble"})"};
    all.insert(all.end(), words.begin(), words.end());
    return run_program(all, place);
  };
  ASSERT_EQ(rendered({"-o", "ball.png", "-o", "ball.1001.png", "-o", "ball.1002.png", "-o", "a.exr", "-o",
                      "room.exr"})
                .exit_code,
            0);
  const struct {
    std::string file;
    std::vector<std::string> words;
  } cases[] = {
      {"ball.png", {"-o", "ball.png", "--set", R"(media.marble.tint={"texture": "ball.png"})"}},
      {"ball.1001.png",
       {"-o", "ball.1001.png", "--set", R"(media.marble.tint={"texture": "ball.<UDIM>.png"})"}},
      {"room.exr", {"-o", "room.exr", "--environment", "room.exr"}},
  };
  for (const auto& [file, words] : cases) {
    const std::string before = bytes_of(place + file);
    const Outcome outcome = rendered(words);
    EXPECT_EQ(outcome.exit_code, 2) << file;
    EXPECT_TRUE(contains(outcome.err, file + ": is an input of the scene and would be overwritten"))
        << outcome.err;
    EXPECT_EQ(bytes_of(place + file), before);
  }
  const std::string before = bytes_of(place + "a.exr");
  const Outcome compared = run_program({"compare", "room.exr", "a.exr", "--error-picture", "a.exr"}, place);
  EXPECT_EQ(compared.exit_code, 2);
  EXPECT_TRUE(contains(compared.err, "a.exr: is an input of the comparison and would be overwritten"))
      << compared.err;
  EXPECT_EQ(bytes_of(place + "a.exr"), before);
}

// Claim: a medium that --set changes and no shape has is reported, with a used one of similar name; one that a shape has is not.
// Fails if a misspelt name of a medium renders the old image without a word.
TEST(CliFailures, UnusedMediaAreReported) {
  const SceneFolder folder;
  const auto warnings = [&](const std::string& name) {
    return run_program({"info", folder.scene, "--set", "media." + name + ".preset=skin1"}).err;
  };
  EXPECT_TRUE(contains(warnings("wax"), "no shape uses the medium 'wax' of --set media.wax...."))
      << warnings("wax");
  EXPECT_EQ(warnings("marble"), "");
  EXPECT_FALSE(contains(warnings("wax"), "did you mean"));
  const Outcome similar = run_program({"info", folder.scene, "--set", "media.jade.preset=marble", "--set",
                                       "shapes.ball.medium=jade", "--set", "media.jede.preset=marble"});
  EXPECT_TRUE(contains(
      similar.err, "no shape uses the medium 'jede' of --set media.jede.... (did you mean 'jade'?); assign"))
      << similar.err;
  const Outcome layer =
      run_program({"info", folder.scene, "--set", "media.wax.preset=skin1", "--set",
                   R"(media.marble={"layers": [{"medium": "wax", "thickness": 1}, {"medium": "wax"}]})"});
  EXPECT_FALSE(contains(layer.err, "no shape uses")) << layer.err;
}

// Claim: a floor so large that rays from it start visibly above it is reported with the shape that it dwarfs, one of usual size is
// not. Source: by eye, a lit disc in the contact shadow from 20,000 mm on. Fails if shadows vanish without a word.
TEST(CliFailures, HugeShapesAreReported) {
  const auto warnings = [&](const std::string& half) {
    const ScratchFolder folder;
    put_bytes(folder.file("scene.json"),
              R"({"shapes": [{"name": "ball", "sphere": {"center": [0, 10, 0], "radius": 10}},
      {"name": "floor", "quad": {"corner": [-)" +
                  half + ", 0, " + half + R"(], "u": [)" + half + R"(, 0, 0], "v": [0, 0, -)" + half +
                  R"(]}}], "lights": [{"type": "directional", "direction": [0, -1, -0.3], "irradiance": 2}],
      "camera": {"position": [0, 40, 60], "look_at": [0, 5, 0]}})");
    return run_program({"info", folder.file("scene.json")}).err;
  };
  EXPECT_TRUE(contains(warnings("40000"), "shape 'floor' extends ")) << warnings("40000");
  EXPECT_EQ(warnings("2000"), "");
}

}  // namespace
}  // namespace opaline
