// SPDX-License-Identifier: GPL-3.0-or-later
// Opaque things and the light between them against an independent path tracer, Mitsuba 3, which `tests/run --long` fetches
// from PyPI.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/scratch_folder.h"
#include "input/load_scene.h"
#include "opaline/image.h"
#include "session/session_records.h"

namespace opaline {
namespace {

constexpr std::size_t kBlock = 8;  // pixels: a mean over so many a side has little noise

/// Means of R, G, B over blocks of pixels, row by row.
std::vector<std::array<double, 3>> blocks_of(const Image& image) {
  const std::size_t width = std::size_t(image.width) / kBlock, height = std::size_t(image.height) / kBlock;
  std::vector<std::array<double, 3>> blocks(width * height);
  std::array<std::size_t, 3> place{};
  for (std::size_t c = 0; c < 3; ++c)
    place[c] =
        std::size_t(std::ranges::find(image.channels, std::string(1, "RGB"[c])) - image.channels.begin());
  for (std::size_t y = 0; y < height * kBlock; ++y)
    for (std::size_t x = 0; x < width * kBlock; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        blocks[y / kBlock * width + x / kBlock][c] +=
            double(image.pixels[(y * std::size_t(image.width) + x) * image.channels.size() + place[c]]) /
            double(kBlock * kBlock);
  return blocks;
}

std::array<double, 3> mean_of(const std::vector<std::array<double, 3>>& blocks) {
  std::array<double, 3> mean{};
  for (const auto& block : blocks)
    for (std::size_t c = 0; c < 3; ++c) mean[c] += block[c] / double(blocks.size());
  return mean;
}

struct LongMitsuba : ::testing::Test {
  ScratchFolder folder;
  const std::string scripts = OPALINE_SCENES_DIR "/../tests/render/mitsuba/";
  const std::string python = OPALINE_SCENES_DIR "/../build-mitsuba/bin/python3";

  void SetUp() override {
    if (!std::filesystem::exists(python)) GTEST_SKIP() << "Mitsuba is not there; tests/run --long fetches it";
  }

  /// Expects the whole and each block to be Mitsuba's within so much; of a block, of itself and a twentieth of the mean.
  void expect_same(const std::string& scene, const std::vector<std::string>& overrides, int bounces,
                   double whole, double block) const {
    const std::string out = folder.file("mitsuba.exr");
    const std::string command = python + " " + scripts + "render_by_mitsuba.py " + scene + " " + out + " " +
                                std::to_string(bounces) + " 1024 > " + folder.file("log") + " 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << bytes_of(folder.file("log"));
    Session session;
    session.edit(load_scene(scene, overrides));
    const auto ours = blocks_of(session.render().image), theirs = blocks_of(read_image(out));
    const auto our_mean = mean_of(ours), mean = mean_of(theirs);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(our_mean[c] / mean[c], 1, whole) << "RGB"[c];
      for (std::size_t i = 0; i < ours.size(); ++i)
        EXPECT_NEAR(ours[i][c], theirs[i][c], block * (theirs[i][c] + .05 * mean[c])) << i << ' ' << "RGB"[c];
    }
  }
};

constexpr int kAll = 200;  // bounces

// Claim: a red wall, a floor and a ball under a lamp, without and with light that they send to each other, are what a
// path tracer makes of them. Tolerance: .5 % of the whole, 3 % of a block (the noise of both). Fails if: a bounce is left out
// (the whole is then 11 % darker in red), or counted twice.
TEST_F(LongMitsuba, LightBetweenThings) {
  for (const int bounces : {0, 1})
    expect_same(scripts + "room.json", {"settings.bounces=" + std::to_string(bounces)}, bounces * kAll, .005,
                .03);
}

// Claim: a ball in a closed white room with a reflectance of .8 is what a path tracer makes of it. Tolerance: 1 % of the
// whole, 6 % of a block. Fails if: light bounces once (the whole is then half as bright).
TEST_F(LongMitsuba, WhiteBox) {
  expect_same(scripts + "white_box.json", {}, kAll, .01, .06);
}

// Claim: a rough coat mirrors a lamp as Mitsuba's GGX dielectric does. Tolerance: 1 % of the whole (measured .4 %), 6 % of a
// block (4.1 %, noise). What Mitsuba lacks, light that is reflected more than once among the facets, is .3 % here and 2.6 %
// at a roughness of .8. Fails if: the roughness is squared once too often, or a half of the highlight is missing.
TEST_F(LongMitsuba, RoughCoat) {
  for (const char* roughness : {"0.3", "0.5"}) {
    SCOPED_TRACE(roughness);
    std::string text = bytes_of(scripts + "gloss.json");
    const std::string given = "\"specular_roughness\": 0.5";
    text.replace(text.find(given), given.size(), std::string("\"specular_roughness\": ") + roughness);
    put_bytes(folder.file("gloss.json"), text);
    expect_same(folder.file("gloss.json"), {}, 0, .01, .06);
  }
}

// Claim: a rough coat in a rough metal, and the metal in the coat, are what a path tracer sees through four mirrors.
// Tolerance: 1 % of the whole (measured .24 %; what Mitsuba lacks is .5 %), 10 % of a block (8.2 %, noise of rays that
// chance upon the lamp's image). Fails if coats in mirrors are passed over (the whole is then 38 % darker), or both mirrors
// draw the same directions (a block is then half as bright).
TEST_F(LongMitsuba, CoatsInMirrors) {
  expect_same(scripts + "mirrors.json", {}, 4, .01, .1);
}

// Claim: a metal that is brushed mirrors a lamp as Mitsuba's anisotropic GGX conductor does, along u and across.
// Tolerance: 1 % of the whole (measured .6 %; light that facets reflect twice, which Mitsuba lacks, is .2 %), 6 % of a
// block (5.1 %, noise). Fails if u is taken for v, or an alpha is not OpenPBR's.
TEST_F(LongMitsuba, BrushedMetal) {
  expect_same(scripts + "brushed.json", {}, 0, .01, .06);
}

}  // namespace
}  // namespace opaline
