// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline render`: images, their metadata, and the memory for them.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

std::map<std::string, std::string> metadata_of(const std::string& path) {
  const Image image = read_image(path);
  return {image.metadata.begin(), image.metadata.end()};
}

void write_even_room(const std::string& path, int height, float radiance) {
  Image picture;
  picture.width = picture.full_width = 2 * height;
  picture.height = picture.full_height = height;
  picture.channels = {"R", "G", "B", "A"};
  picture.pixels.resize(std::size_t(8 * height * height));
  std::ranges::fill(picture.pixels, radiance);
  write_exr(path, picture, false);
}

// Claim: one run writes each output in its format; the EXR says what it was made from.
// Source: metadata.h. Fails if: an output is skipped, or a value is taken from the command line instead of
// the scene.
TEST(CliRender, WritesPicturesAndMetadata) {
  const SceneFolder folder;
  const std::string exr = folder.file("a.exr"), png = folder.file("a.PNG"), ply = folder.file("a.ply");
  const Outcome outcome = run_program({"render", "-o", exr, "-o", png, folder.scene, "--samples-ply", ply,
                                       "--spp", "2", "--set", "settings.seed=5", "--crop", "4,8,20,32"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Image picture = read_image(exr);
  EXPECT_EQ(picture.width, 16);
  EXPECT_EQ(picture.height, 24);
  EXPECT_EQ(read_image(png).width, 16);
  EXPECT_TRUE(bytes_of(ply).starts_with("ply\n"));

  auto metadata = metadata_of(exr);
  EXPECT_EQ(metadata["opaline:scene"], "ball.json");
  EXPECT_EQ(metadata["opaline:seed"], "5");
  EXPECT_TRUE(std::regex_match(metadata["opaline:version"], std::regex("\\d+\\.\\d+\\.\\d+")));
  EXPECT_TRUE(std::regex_match(metadata["opaline:scene_hash"], std::regex("[0-9A-Fa-f]{40}")));
  const nlohmann::json settings = nlohmann::json::parse(metadata["opaline:settings"]);
  EXPECT_EQ(settings["samples_per_pixel"], 2);
  EXPECT_EQ(settings["crop"], (std::vector<int>{4, 8, 20, 32}));
  const std::size_t samples = settings["groups"][0]["samples"];
  EXPECT_TRUE(contains(bytes_of(ply), "element vertex " + std::to_string(samples) + "\n"));
  EXPECT_FALSE(metadata.contains("opaline:timings"));
}

// Claim: the same bytes in every output for any number of threads and file names, and on every run.
// Source: the design ("Bits do not move"). Fails if: metadata holds the thread count, a time or an output's
// name.
TEST(CliRender, BytesDoNotMove) {
  const SceneFolder folder;
  const auto render = [&](const std::string& name, const std::string& threads) {
    const Outcome outcome = run_program({"render", folder.scene, "-o", folder.file(name + ".exr"), "-o",
                                         folder.file(name + ".png"), "--samples-ply",
                                         folder.file(name + ".ply"), "--threads", threads, "--quiet"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  };
  render("one", "1");
  render("two", "2");
  render("again", "2");
  for (const char* extension : {".exr", ".png", ".ply"}) {
    const std::string expected = bytes_of(folder.file(std::string("one") + extension));
    EXPECT_FALSE(expected.empty());
    EXPECT_TRUE(bytes_of(folder.file(std::string("two") + extension)) == expected) << extension;
    EXPECT_TRUE(bytes_of(folder.file(std::string("again") + extension)) == expected) << extension;
  }
}

// Claim: the command in the metadata makes the same file again, byte for byte, quotes and all.
// Source: metadata.h. Fails if: an override is left out of it, or not quoted.
TEST(CliRender, CommandOfTheMetadataReproduces) {
  const SceneFolder folder;
  const std::string first = folder.file("first.exr");
  const Outcome outcome =
      run_program({"render", folder.scene, "-o", first, "--resolution", "20x10", "--seed", "3", "--set",
                   R"(lights.key.intensity=[9e2, 7e2, 5e2])", "--set", "shapes.ball.name=the artist's ball"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string line = metadata_of(first)["opaline:command"];
  ASSERT_TRUE(line.starts_with("opaline render ball.json "));
  const std::string shell = "cd '" + folder.path.string() + "' && '" + OPALINE_PROGRAM + "'" +
                            line.substr(std::string("opaline").size()) + " -o second.exr --quiet";
  ASSERT_EQ(std::system(shell.c_str()), 0) << shell;
  EXPECT_TRUE(bytes_of(folder.file("second.exr")) == bytes_of(first));
}

// Claim: the scene's hash changes with a byte of the file and with an override, and with nothing else.
// Source: metadata.h. Fails if: overrides are not hashed.
TEST(CliRender, SceneHash) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr");
  const auto hash = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", folder.scene, "-o", out, "--quiet", "--method", "lambert"});
    EXPECT_EQ(run_program(more).exit_code, 0);
    return metadata_of(out)["opaline:scene_hash"];
  };
  const std::string plain = hash({});
  EXPECT_EQ(hash({"--threads", "1"}), plain);
  EXPECT_NE(hash({"--seed", "1"}), plain);
  put_bytes(folder.scene, bytes_of(folder.scene) + " ");
  EXPECT_NE(hash({}), plain);
}

// Claim: it changes with the bytes of a mesh file that a shape shows, each time the file changes, and not
// with a file that no shape shows. Source: metadata.h. Fails if: mesh files are not hashed.
TEST(CliRender, SceneHashCoversMeshFiles) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr"), mesh = folder.file("wedge.obj");
  const std::string obj = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const auto hash = [&](const std::string& bytes, const std::string& shape) {
    put_bytes(mesh, bytes);
    const std::vector<std::string> line{
        "render", folder.scene, "-o", out, "--quiet", "--method", "lambert", "--set", "shapes=" + shape};
    EXPECT_EQ(run_program(line).exit_code, 0);
    return metadata_of(out)["opaline:scene_hash"];
  };
  const std::string shown = R"([{"file": "wedge.obj"}, {"sphere": {"radius": 1}}, {"file": "wedge.obj"}])",
                    hidden = R"([{"sphere": {"radius": 1}}])";
  EXPECT_EQ(hash(obj, shown), hash(obj, shown));
  EXPECT_NE(hash(obj + "# other bytes\n", shown), hash(obj, shown));
  EXPECT_EQ(hash(obj + "# other bytes\n", hidden), hash(obj, hidden));
}

// Claim: so it does with the picture of a room, without which an old frame would be taken for one in the new light.
// Source: scene_hash.h. Fails if: pictures of rooms are not hashed.
TEST(CliRender, SceneHashCoversRooms) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr"), room = folder.file("room.exr");
  const auto hash = [&](float radiance) {
    write_even_room(room, 4, radiance);
    const std::vector<std::string> line{"render",  folder.scene,    "-o", out, "--quiet", "--method",
                                        "lambert", "--environment", room};
    EXPECT_EQ(run_program(line).exit_code, 0);
    return metadata_of(out)["opaline:scene_hash"];
  };
  const std::string dim = hash(1);
  EXPECT_EQ(hash(1), dim);
  EXPECT_NE(hash(2), dim);
}

// Claim: an EXR holds R, G, B, A and diffuse unless --layers says what else, all or none; a mistyped name is
// answered with the nearest one, and a layer that the method lacks before the work. Source: the help. Fails
// if: the option is not passed on, or the check comes after the picture.
TEST(CliRender, LayersOnRequest) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr");
  const auto layers = [&](const std::string& asked) {
    std::vector<std::string> line{"render", folder.scene, "-o", out, "--quiet"};
    if (!asked.empty()) line.insert(line.end(), {"--layers", asked});
    EXPECT_EQ(run_program(line).exit_code, 0) << asked;
    std::set<std::string> names;
    for (const std::string& channel : read_image(out).channels)
      names.insert(channel.substr(0, channel.find('.')));
    return names;
  };
  using Names = std::set<std::string>;
  EXPECT_EQ(layers(""), (Names{"R", "G", "B", "A", "diffuse"}));
  EXPECT_EQ(layers("none"), (Names{"R", "G", "B", "A"}));
  EXPECT_EQ(layers("N,error"), (Names{"R", "G", "B", "A", "N", "error"}));
  EXPECT_EQ(layers("all"), (Names{"R", "G", "B", "A", "Z", "diffuse", "specular", "albedo", "N", "P",
                                  "irradiance", "error"}));
  const Outcome typo = run_program({"render", folder.scene, "-o", out, "--layers", "N,difuse"});
  EXPECT_EQ(typo.exit_code, 2);
  EXPECT_TRUE(contains(typo.err, "diffuse")) << typo.err;
  const Outcome other = run_program({"render", folder.scene, "-o", out, "--layers", "variance"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(contains(other.err, "--method direct")) << other.err;
}

/// The value of a channel where the picture is brightest.
float at_brightest(const Image& image, const std::string& channel) {
  const auto place = [&](const std::string& name) {
    return std::size_t(std::ranges::find(image.channels, name) - image.channels.begin());
  };
  std::size_t brightest = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += image.channels.size())
    if (image.pixels[i + place("G")] > image.pixels[brightest + place("G")]) brightest = i;
  return image.pixels.at(brightest + place(channel));
}

// Claim: --layers wavelengths writes a channel for each wavelength, by `direct` too, and is exit 2 for a scene in red, green and
// blue. Source: scenes/README.md. Fails if: `direct`, which makes its image itself, has none.
TEST(CliRender, WavelengthsAreLayers) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr");
  for (const std::string method : {"lambert", "direct"}) {
    const Outcome outcome = run_program({"render", folder.scene, "-o", out, "--method", method, "--layers",
                                         "diffuse,wavelengths", "--set", "film.wavelengths=3", "--quiet"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::vector<std::string> channels = read_image(out).channels;
    for (const char* name : {"R", "diffuse.G", "S0.443,15nm", "S0.541,924nm", "S0.626,657nm"})
      EXPECT_NE(std::ranges::find(channels, name), channels.end()) << method << ' ' << name;
  }
  const Outcome refused = run_program({"render", folder.scene, "-o", out, "--layers", "wavelengths"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "the scene has no spectra")) << refused.err;
}

// Claim: --layers all,light_groups,cryptomatte writes the layers of both beside all others, whose values stay; the
// command in the metadata asks for them again, and a method without light groups is refused before the work. Source:
// scenes/README.md. Fails if a word is not passed on, or `all` alone costs a picture for each light.
TEST(CliRender, LightGroupsAndMattes) {
  const SceneFolder folder;
  const std::string plain = folder.file("plain.exr"), out = folder.file("a.exr");
  const std::vector<std::string> line{
      "render", folder.scene, "--quiet", "--set",
      R"(lights=[{"name":"key","type":"point","position":[20,30,40],"intensity":1000},)"
      R"({"type":"point","position":[-20,0,40],"intensity":[100,200,300]}])"};
  const auto with = [&](const std::string& layers, const std::string& path) {
    std::vector<std::string> all = line;
    all.insert(all.end(), {"--layers", layers, "-o", path});
    return run_program(all);
  };
  ASSERT_EQ(with("all", plain).exit_code, 0);
  const Outcome outcome = with("all,light_groups,cryptomatte", out);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Image before = read_image(plain), after = read_image(out);
  for (const std::string& channel : before.channels)
    EXPECT_EQ(at_brightest(before, channel), at_brightest(after, channel)) << channel;
  EXPECT_EQ(after.channels.size(), before.channels.size() + 2 * 6 + 24);
  EXPECT_EQ(at_brightest(after, "CryptoObject00.G"), 1);
  for (const char* c : {".R", ".G", ".B"}) {
    const float sum = at_brightest(after, std::string("diffuse_key") + c) +
                      at_brightest(after, std::string("diffuse_light1") + c);
    EXPECT_NEAR(sum, at_brightest(after, std::string("diffuse") + c), .001f * sum) << c;  // of halves
  }
  EXPECT_TRUE(contains(metadata_of(out)["opaline:command"], " --layers all,light_groups,cryptomatte"));
  const Outcome noisy =
      run_program({"render", folder.scene, "-o", out, "--layers", "light_groups", "--method", "direct"});
  EXPECT_EQ(noisy.exit_code, 2);
  EXPECT_TRUE(contains(noisy.err, "light groups")) << noisy.err;
  const Outcome hurried =
      run_program({"render", folder.scene, "-o", out, "--layers", "cryptomatte", "--time-budget", "1s"});
  EXPECT_EQ(hurried.exit_code, 2);
  EXPECT_TRUE(contains(hurried.err, "--layers cryptomatte")) << hurried.err;
}

// Claim: a PNG is not cut at white unless --view srgb asks for it, and the EXR has the same values in each view and, read
// again, in ACEScg. Source: scenes/README.md. Fails if the default cuts, or film.color_space changes the PNG.
TEST(CliRender, ViewsAndColorSpaces) {
  const SceneFolder folder;
  const std::string exr = folder.file("a.exr"), png = folder.file("a.png");
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> line{
        "render", folder.scene,           "-o", exr, "-o", png, "--quiet", "--exposure", "4",
        "--set",  "film.pixel_type=float"};
    line.insert(line.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(line).exit_code, 0);
    const ZeroedArray<float> pixels = read_image(png).pixels;
    return *std::ranges::max_element(pixels);
  };
  EXPECT_EQ(render({"--view", "srgb"}), 1);
  const Image plain = read_image(exr);
  for (const char* view : {"soft", "neutral", "agx"}) {
    EXPECT_LT(render({"--view", view}), 1) << view;
    EXPECT_EQ(read_image(exr).pixels, plain.pixels);
  }
  EXPECT_LT(render({}), 1);
  const Image shown = read_image(png);
  render({"--set", "film.color_space=acescg"});
  EXPECT_EQ(read_image(png).pixels, shown.pixels);
  const Image converted = read_image(exr);
  for (const char* channel : {"R", "G", "B", "A"})
    EXPECT_NEAR(at_brightest(converted, channel), at_brightest(plain, channel), 2e-6f) << channel;
  EXPECT_EQ(run_program({"compare", exr, exr}).exit_code, 0);
}

// Claim: timings are in the file only when asked for. Source: arguments.h. Fails if: the flag does nothing.
TEST(CliRender, TimingsOnRequest) {
  const SceneFolder folder;
  const std::string out = folder.file("a.exr");
  ASSERT_EQ(run_program({"render", folder.scene, "-o", out, "--timings-in-metadata"}).exit_code, 0);
  const nlohmann::json timings = nlohmann::json::parse(metadata_of(out)["opaline:timings"]);
  EXPECT_EQ(timings.back()["stage"], "shading");
  EXPECT_GE(timings.back()["wall_seconds"], 0.0);
}

#ifndef __SANITIZE_ADDRESS__  // which takes memory of its own
struct PlannedMemory {
  double planned = 0, taken = 0;  // bytes
};

PlannedMemory planned_memory(const std::string& scene, const std::vector<std::string>& options,
                             const std::string& name = "a.exr") {
  const SceneFolder folder;
  std::vector<std::string> arguments{"render", scene, "-o", folder.file(name), "--log", "json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto events = events_of(run_program(arguments).out);
  return {event_of(events, "plan")["memory_bytes"], events.back()["peak_memory_bytes"]};
}

// Claim: the plan's memory is an upper bound, and at most 1.5 times what is taken, for small and large pictures, all
// layers, area lights, a plate, media that vary inside, and cells that light bounces to. Fails if: empty pixels count (1.7
// at 2048 x 2048), what is on its way into the file does not (.95), or a cell's own medium does not (.94).
TEST(CliRender, PlansTheMemoryItTakes) {
  const std::string scenes = std::string(OPALINE_SCENES_DIR) + "/";
  const std::vector<std::vector<std::string>> jobs{
      {"bunny-marble.json"},
      {"bunny-marble.json", "--resolution", "2048x2048"},
      {"bunny-skin1.json", "--resolution", "1024x1024", "--layers", "all"},
      {"sphere.json", "--resolution", "128x128"},
      {"veins.json", "--resolution", "48x20", "--set", "settings.bounces=0", "--set",
       "settings.light_samples=1", "--set", R"(shapes=[{"sphere": {"radius": 14}, "medium": "veined"}])"},
      {"backlit-slab.json"},
      {"bunny-marble.json", "--method", "volume_diffusion", "--resolution", "256x256", "--set",
       "settings.bounces=1", "--set", "settings.samples=60000"}};
  for (const std::vector<std::string>& job : jobs) {
    const PlannedMemory memory = planned_memory(scenes + job[0], {job.begin() + 1, job.end()});
    EXPECT_LE(memory.taken, memory.planned) << job[0];
    EXPECT_LE(memory.planned, 1.5 * memory.taken) << job[0];
  }
}

// Claim: so it is for frames, as they share the view of the camera. Fails if: the view is left out (1.17 of the plan is taken).
TEST(CliRender, PlansTheMemoryOfFrames) {
  const PlannedMemory memory = planned_memory(std::string(OPALINE_SCENES_DIR) + "/bunny-marble.json",
                                              {"--frames", "1-2", "--method", "lambert"}, "a.##.exr");
  EXPECT_LE(memory.taken, memory.planned);
  EXPECT_LE(memory.planned, 1.5 * memory.taken);
}

// Claim: so it is of random walks in plates whose voxels are many. Tolerance: 1.5. Fails if: voxels of free distances are
// left out (3.6 times).
TEST(CliRender, PlansTheMemoryOfWalks) {
  const PlannedMemory memory = planned_memory(std::string(OPALINE_TEST_INPUTS) + "/mem-volume.json", {});
  EXPECT_LE(memory.taken, memory.planned);
  EXPECT_LE(memory.planned, 1.5 * memory.taken);
}

// Claim: so it is in the light of a picture, small and of 2048 x 1024 pixels. Fails if: the library that reads it is
// left out (.54 of what is taken), or the picture (.94).
TEST(CliRender, PlansTheMemoryOfEnvironments) {
  const SceneFolder folder;
  for (const int height : {8, 1024}) {
    write_even_room(folder.file("room.exr"), height, 1);
    const PlannedMemory memory = planned_memory(folder.scene, {"--environment", folder.file("room.exr")});
    EXPECT_LE(memory.taken, memory.planned) << height;
    EXPECT_LE(memory.planned, 1.3 * memory.taken) << height;
  }
}
#endif

// Claim: `render` and `info` report flush faces of two media, and bodies in a closed opaque box: from outside of it, or without a light
// inside; an open box and a lit room are none. Source: placement_warnings.h. Fails if: speckle and black images are silent.
TEST(CliRender, PlacementsAreReported) {
  const ScratchFolder folder;
  const auto warnings_of = [&](const std::string& other, const std::string& camera,
                               const std::string& light) {
    put_bytes(folder.file("a.json"),
              R"({"media": {"m": {"preset": "marble"}, "n": {"preset": "skin1"}}, "shapes": [
        {"name": "cube", "box": {"low": [0, 0, 0], "high": [20, 20, 20]}, "medium": "m"},
        {"name": "ball", "sphere": {"center": [-15, 8, 8], "radius": 8}, "medium": "n"}, )" +
                  other + R"(], "lights": [{"type": "point", "position": )" + light +
                  R"(, "intensity": 9000}], "camera": {"position": )" + camera +
                  R"(, "look_at": [10, 8, 0]}, "film": {"resolution": [16, 16]},
        "settings": {"bounces": 0, "samples": 500}})");
    const std::string info = run_program({"info", folder.file("a.json")}).err,
                      render = run_program({"render", folder.file("a.json"), "-o", folder.file("a.exr"),
                                            "--method", "hierarchical"})
                                   .err;
    for (const char* text : {"have coincident faces", "inside the closed opaque"})
      EXPECT_EQ(contains(info, text), contains(render, text)) << info << render;
    return info;
  };
  const std::string
      flush = R"({"name": "b", "box": {"low": [5, -5, 5], "high": [15, 15, 20]}, "medium": "n"})",
      box = R"({"name": "b", "box": {"low": [-30, -5, -5], "high": [90, 90, 90]}})",
      part = R"({"name": "b", "box": {"low": [-5, -5, -5], "high": [25, 25, 12]}})",
      side = R"({"name": "b", "quad": {"corner": [-5, -5, 25], "u": [30, 0, 0], "v": [0, 30, 0]}})",
      near = "[10, 30, 80]", far = "[10, 30, 180]", inside = "[30, 60, 60]", outside = "[30, 160, 60]";
  EXPECT_TRUE(contains(warnings_of(flush, near, inside), "the shapes 'cube' and 'b' have coincident faces"));
  EXPECT_TRUE(contains(warnings_of(box, far, inside),
                       "cube, ball: inside the closed opaque shape 'b'; the camera is outside"));
  EXPECT_TRUE(contains(warnings_of(box, near, outside),
                       "cube, ball: inside the closed opaque shape 'b'; all lights are outside"));
  EXPECT_FALSE(contains(warnings_of(box, near, inside), "inside the closed"));
  EXPECT_FALSE(contains(warnings_of(part, far, inside), "inside the closed"));
  EXPECT_FALSE(contains(warnings_of(side, far, inside), "inside the closed"));
}

// Claim: the exposure brightens the PNG alone. Source: scene.h. Fails if: it is applied to the EXR, or not at
// all.
TEST(CliRender, ExposureIsForThePng) {
  const SceneFolder folder;
  const auto render = [&](const std::string& stops) {
    const std::vector<std::string> line{"render",  folder.scene,         "-o",         folder.file("a.exr"),
                                        "-o",      folder.file("a.png"), "--exposure", stops,
                                        "--quiet", "--method",           "lambert"};
    ASSERT_EQ(run_program(line).exit_code, 0);
  };
  render("-1");
  const ZeroedArray<float> exr = read_image(folder.file("a.exr")).pixels,
                           dark = read_image(folder.file("a.png")).pixels;
  render("1");
  EXPECT_EQ(read_image(folder.file("a.exr")).pixels, exr);
  const ZeroedArray<float> bright = read_image(folder.file("a.png")).pixels;
  double sums[2] = {};
  for (std::size_t i = 0; i < dark.size(); ++i) {
    sums[0] += double(dark[i]);
    sums[1] += double(bright[i]);
  }
  EXPECT_GT(sums[1], 2 * sums[0]);
}

}  // namespace
}  // namespace opaline
