// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh paths that lead to something else than a mesh, as the program's commands meet them.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

/// The outcome of rendering a scene with this one mesh; killed after 20 s.
Outcome render_of(const SceneFolder& folder, const std::string& mesh, const std::string& command) {
  put_bytes(folder.scene, R"({"shapes": [{"file": ")" + mesh + R"("}], "film": {"resolution": [8, 8]}})");
  std::vector<std::string> words{command, folder.scene};
  if (command == "render") words.insert(words.end(), {"-o", folder.file("a.exr")});
  Limits limits;
#ifndef __SANITIZE_ADDRESS__  // which needs more address space
  limits.address_space = rlim_t(2) << 30;
#endif
  return Child(words, ".", limits).wait(20);
}

// Claim: `render` looks at what a mesh path leads to before it reads it, as `info` does: a folder, a pipe
// that nobody writes to, a missing file, and binary STL of 3 GB that holds one triangle are each named, exit
// 2, within 2 GB of address space. Fails if: the hash of the scene or the key of a shape reads a file before
// it is checked.
TEST(CliMeshes, WhatIsNoMeshIsNamedBeforeItIsRead) {
  const SceneFolder folder;
  std::filesystem::create_directory(folder.file("folder.obj"));
  ASSERT_EQ(::mkfifo(folder.file("pipe.ply").c_str(), 0600), 0);
  std::string triangle(84 + 50, '\0');
  triangle[80] = 1;
  put_bytes(folder.file("sparse.stl"), triangle);
  std::filesystem::resize_file(folder.file("sparse.stl"), std::uintmax_t(3) << 30);
  const struct {
    const char *mesh, *said;
  } cases[] = {
      {"folder.obj", "folder.obj: is a folder (expected a regular file)"},
      {"pipe.ply", "pipe.ply: is a pipe (expected a regular file)"},
      {"missing.obj", "missing.obj: no such mesh file"},
      {"sparse.stl", "sparse.stl: the file is much longer than its header states (expected 134 bytes"}};
  for (const char* command : {"render", "info"})
    for (const auto& c : cases) {
      const Outcome outcome = render_of(folder, c.mesh, command);
      EXPECT_EQ(outcome.exit_code, 2) << command << ' ' << c.mesh << " signal " << outcome.signal;
      EXPECT_TRUE(contains(outcome.err, c.said)) << outcome.err;
    }
}

// Claim: a pipe that nobody writes to is named, whatever file it stands for, and nothing waits for it. Fails if: one of the
// files is opened by itself.
TEST(CliInputs, PipesAreRefused) {
  const SceneFolder folder;
  for (const char* name :
       {"pipe.json", "pipe.glb", "pipe.mtlx", "pipe.png", "pipe.exr", "pipe.bin", "pipe.obj"})
    ASSERT_EQ(::mkfifo(folder.file(name).c_str(), 0600), 0);
  put_bytes(folder.file("texture.json"),
            R"({"shapes": [{"sphere": {"radius": 1}, "reflectance": {"texture": "pipe.png"}}]})");
  put_bytes(folder.file("room.json"), R"({"lights": [{"type": "environment", "file": "pipe.exr"}]})");
  put_bytes(folder.file("buffer.gltf"),
            R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "pipe.bin", "byteLength": 36}]})");
  put_bytes(folder.file("wax.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string out = folder.file("a.exr");
  const struct {
    std::vector<std::string> words;
    const char* pipe;
  } cases[] = {{{"render", "pipe.json", "-o", out}, "pipe.json"},
               {{"info", "pipe.glb"}, "pipe.glb"},
               {{"render", "pipe.obj", "-o", out}, "pipe.obj"},
               {{"render", "texture.json", "-o", out}, "pipe.png"},
               {{"render", "room.json", "-o", out}, "pipe.exr"},
               {{"render", "buffer.gltf", "-o", out}, "pipe.bin"},
               {{"import", "wax.obj", "--material", "pipe.mtlx", "-o", "b.json"}, "pipe.mtlx"},
               {{"compare", "pipe.exr", "pipe.exr"}, "pipe.exr"}};
  for (const auto& c : cases) {
    const Outcome outcome = Child(c.words, folder.path.string(), {}).wait(20);
    EXPECT_EQ(outcome.exit_code, 2) << c.pipe << " signal " << outcome.signal;
    EXPECT_TRUE(contains(outcome.err, std::string(c.pipe) + ": is a pipe (expected a regular file)"))
        << outcome.err;
  }
}

// Claim: files that must not be read as they are end the run by name and place. Fails if: an asset reads beyond its folder,
// minus infinity counts as black, or a small file may take gigabytes.
TEST(CliInputs, DangerousFilesAreRefused) {
  const std::string inputs = std::string(OPALINE_TEST_INPUTS) + "/";
  const SceneFolder folder;
  const struct {
    const char *file, *said;
  } cases[] = {{"escape-buffer.gltf", "lies outside of the asset's folder"},
               {"silent-env-minus-inf.json", "env-minus-inf.exr: pixel (7, 4) is not finite"},
               {"slow-png-texture.json", "bomb.png: the image is too large"}};
  for (const auto& c : cases) {
    const Outcome outcome = run_program({"render", inputs + c.file, "-o", folder.file("a.exr")});
    EXPECT_EQ(outcome.exit_code, 2) << c.file;
    EXPECT_TRUE(contains(outcome.err, c.said)) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.exr"))) << c.file;
  }
}

/// Means of R, G and B over an image that the program renders.
std::array<double, 3> mean_of(const SceneFolder& folder, std::vector<std::string> words) {
  words.insert(words.begin(), "render");
  words.insert(words.end(), {"-o", folder.file("mean.exr")});
  const Outcome outcome = run_program(words);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Image image = read_image(folder.file("mean.exr"));
  std::array<double, 3> mean{};
  for (std::size_t p = 0; p < image.pixels.size(); p += image.channels.size())
    for (std::size_t c = 0; c < 3; ++c) {
      const auto at = std::ranges::find(image.channels, std::string(1, "RGB"[c])) - image.channels.begin();
      mean[c] += double(image.pixels[p + std::size_t(at)]) / (double(image.width) * double(image.height));
    }
  return mean;
}

// Claim: an open ball is lit (mean R 0.1848, from the mesh wound outward), a material file that begins with a byte order
// mark makes the cube red, and a closed torus that is turned about the view stays closed and as bright. Tolerance: 1 %, of
// noise. Fails if: parts are wound inward, the mark hides the first material, or seams open when a mesh is turned.
TEST(CliInputs, FilesLookAsTheyMust) {
  const std::string inputs = std::string(OPALINE_TEST_INPUTS) + "/";
  const SceneFolder folder;
  EXPECT_NEAR(mean_of(folder, {inputs + "hole_ok.json", "--method", "hierarchical"})[0], .1848, .0018);
  const auto red = mean_of(folder, {inputs + "bom.obj", "--resolution", "64x64", "--set", "backdrop=0"});
  EXPECT_GT(red[0], 3 * red[1]);
  const std::vector<std::string> turned{inputs + "torus.json", "--set",
                                        "shapes.0.transform.0.rotate.degrees=33.75"};
  const auto straight = mean_of(folder, {inputs + "torus.json"}), other = mean_of(folder, turned);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(other[c], straight[c], .01 * straight[c]);
  const Outcome outcome = run_program({"info", turned[0], turned[1], turned[2]});
  EXPECT_FALSE(contains(outcome.err + outcome.out, "open")) << outcome.err << outcome.out;
}

}  // namespace
}  // namespace opaline
