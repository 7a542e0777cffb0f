// SPDX-License-Identifier: GPL-3.0-or-later
// `--denoise`, with a stand-in for the library that replaces each pixel by the mean of its row.
#include <gtest/gtest.h>

#include <cmath>

#include "image/denoise.h"
#include "opaline/error.h"
#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

/// The stand-in, or another file, as the denoiser until the end of the scope.
struct Denoiser {
  explicit Denoiser(const std::string& file = OPALINE_FAKE_DENOISER) {
    ::setenv("OPALINE_DENOISER", file.c_str(), 1);
  }
  ~Denoiser() { ::unsetenv("OPALINE_DENOISER"); }
};

/// 4 x 2 pixels of different values; the second row is translucent, with an error of .01.
Image noisy() {
  Image image;
  image.width = image.full_width = 4;
  image.height = image.full_height = 2;
  for (const char* layer : {"", "diffuse.", "specular.", "albedo.", "error."})
    for (const char channel : {'R', 'G', 'B'}) image.channels.push_back(std::string(layer) + channel);
  for (const char* channel : {"N.X", "N.Y", "N.Z"}) image.channels.emplace_back(channel);
  image.pixels.resize(8 * image.channels.size());
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      float* const pixel = image.pixels.data() + i * image.channels.size();
      pixel[3 + c] = .1f * float(i % 4) + .01f * float(c);  // diffuse: mean .15
      pixel[6 + c] = float(i % 4 == 0);                     // specular: mean .25
      pixel[c] = pixel[3 + c] + pixel[6 + c] + 5;           // with a lamp's emission
      pixel[9 + c] = .5f;
      pixel[12 + c] = i < 4 ? 0 : .01f;
    }
  return image;
}

// Claim: both layers are filtered, the image changes by as much and keeps emission; where an error is known, the diffuse light changes by at
// most two of it. By hand: means .15 and .25 of a row; .1 becomes .12 within .02. Source: denoise.h. Fails if: the lamp is filtered, or
// translucent shapes are smoothed like noise.
TEST(CliDenoise, KeepsEmissionAndKnownLight) {
  const Denoiser denoiser;
  Image image = noisy();
  denoise(image, std::vector<std::uint8_t>{0, 0, 0, 0, 1, 1, 1, 1}, nullptr);
  const auto at = [&](std::size_t pixel, std::size_t channel) {
    return image.pixels[pixel * image.channels.size() + channel];
  };
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(at(i, 6), .25f, 1e-6f);
    EXPECT_NEAR(at(i, 0), at(i, 3) + at(i, 6) + 5, 1e-5f);
    const float before = .1f * float(i % 4), change = .15f - before;
    EXPECT_NEAR(at(i, 3), i < 4 ? .15f : before + std::copysign(.02f, change), 1e-6f);
    EXPECT_EQ(at(i, 9), .5f);
  }
}

// Claim: negative channels (colours outside Rec.709) stay unchanged. Cancelling throws Error{interrupted}, and an error of the library
// appears with its message. Fails if: negative values become 0.
TEST(CliDenoise, ExtremesOfTheFilter) {
  const Denoiser denoiser;
  Image image = noisy();
  image.pixels[3] = -.2f;
  denoise(image, {}, nullptr);
  EXPECT_EQ(image.pixels[3], -.2f);
  Monitor monitor;
  monitor.cancelled = true;
  EXPECT_THROW(denoise(image, {}, &monitor), Error);
  image.pixels[9] = -1;
  try {
    denoise(image, {}, nullptr);
    ADD_FAILURE() << "no error";
  } catch (const Error& failure) {
    EXPECT_TRUE(contains(failure.what(), "invalid guide")) << failure.what();
  }
}

// Claim: the option filters what is written and says by what; without the library it ends before any work, naming it and the way to it; light
// groups, which would no longer sum to the image, are refused. Source: the help. Fails if: the image is rendered first.
TEST(CliDenoise, OfTheProgram) {
  const SceneFolder folder;
  const std::string noise =
      R"(lights.key={"name": "key", "type": "sphere", "center": [20, 30, 40], "radius": 5, "radiance": 20})";
  const std::vector<std::string> line{
      "render",   folder.scene, "-o",       folder.file("a.exr"),
      "--layers", "specular",   "--set",    "media.marble.specular_roughness=0.4",
      "--set",    noise,        "--denoise"};
  {
    const Denoiser denoiser;
    const Outcome done = run_program(line);
    ASSERT_EQ(done.exit_code, 0) << done.err;
    EXPECT_TRUE(contains(done.out, "by Open Image Denoise 2.0.0")) << done.out;
    const Image image = read_image(folder.file("a.exr"));
    const auto channel =
        std::size_t(std::ranges::find(image.channels, "specular.R") - image.channels.begin());
    ASSERT_LT(channel, image.channels.size());
    const auto at = [&](int x) {
      return image.pixels[std::size_t(16 * image.width + x) * image.channels.size() + channel];
    };
    EXPECT_GT(at(0), 0);
    EXPECT_EQ(at(0), at(31));
    std::vector<std::string> grouped = line;
    grouped[5] = "light_groups";
    EXPECT_TRUE(contains(run_program(grouped).err, "do not sum to a denoised image"));
  }
  const Denoiser missing("/nowhere/libOpenImageDenoise.so.2");
  std::filesystem::remove(folder.file("a.exr"));
  const Outcome refused = run_program(line);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_TRUE(contains(refused.err, "cannot load the denoiser") && contains(refused.err, "pyoidn"))
      << refused.err;
  EXPECT_FALSE(contains(refused.out, "shading         ")) << refused.out;
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.exr")));
}

}  // namespace
}  // namespace opaline
