// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline compare`: figures, exit codes, and answers to pictures that do not fit.
#include <gtest/gtest.h>

#include <limits>

#include "opaline/image.h"
#include "run_program.h"
#include "support/write_raw_exr.h"

namespace opaline {
namespace {

constexpr int kSize = 16;

/// kSize x kSize pixels: R, G, B are 1, 2, 4 times `value`, diffuse is half of that, and coverage is 1 in the
/// upper half, where alone the values count.
Image picture(float value) {
  Image image;
  image.width = image.height = kSize;
  image.channels = {"R", "G", "B", "A", "diffuse.R", "diffuse.G", "diffuse.B"};
  for (int i = 0; i < kSize * kSize; ++i) {
    const bool object = i < kSize * kSize / 2;
    const float v = object ? value : 50 * value;
    image.pixels.insert(image.pixels.end(), {v, 2 * v, 4 * v, object ? 1.0f : 0.0f, v / 2, v, 2 * v});
  }
  return image;
}

/// A folder with pictures in it.
struct Gallery : ScratchFolder {
  std::string put(const std::string& name, const Image& image) const {
    write_exr(file(name), image, /*half=*/false);
    return file(name);
  }
};

std::string put_raw(const std::string& path, const Image& image) {
  test::write_raw_exr(path, image);
  return path;
}

nlohmann::json comparison_of(const Outcome& outcome) {
  EXPECT_EQ(events_of(outcome.out).size(), 1u);
  return event_of(events_of(outcome.out), "comparison");
}

// Claim: a picture does not differ from itself, in EXR and PNG: zeros, exit 0 at the bound 0, halves too.
// Source: compare.h. Fails if: the comparison is not "above" but "not below", or A is compared with a copy
// that went through half floats.
TEST(CliCompare, ItselfIsZero) {
  const Gallery gallery;
  const std::string exr = gallery.put("a.exr", picture(.3f)), png = gallery.file("a.png");
  write_png(png, picture(.1f), 0);
  for (const std::string& path : {exr, png}) {
    const Outcome outcome = run_program({"compare", path, path, "--fail-above", "0", "--json"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const nlohmann::json result = comparison_of(outcome);
    for (const char* row : {"R", "G", "B", "all"})
      for (const char* figure :
           {"mean_relative_error", "relmse", "p99_relative_error", "max_relative_error", "signed_mean"})
        EXPECT_EQ(result["errors"][row][figure], 0) << row << " " << figure;
    EXPECT_EQ(result["flip"]["max"], 0);
    EXPECT_EQ(result["object_pixels"], path == exr ? kSize * kSize / 2 : kSize * kSize);
    EXPECT_TRUE(result["passed"]);
  }
  const Outcome halves = run_program({"compare", exr, "--halves", exr, exr, "--json"});
  EXPECT_EQ(comparison_of(halves)["errors"]["all"]["squared_error"], 0);
}

// Claim: the figures are those of the object in the layer asked for. By hand: a is 10 % above b where A > 0,
// 400 % elsewhere; the diffuse layer is 20 % below. Tolerance: float rounding. Fails if: the coverage is not
// looked at, or --layer is.
TEST(CliCompare, FiguresOfTheObject) {
  const Gallery gallery;
  Image a = picture(.11f), b = picture(.1f);
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const std::size_t pixel = i / 7, channel = i % 7;
    if (channel > 3) a.pixels[i] = .8f * b.pixels[i];
    if (channel < 3 && pixel >= kSize * kSize / 2) a.pixels[i] *= 5;
  }
  const std::string picture_path = gallery.put("a.exr", a), reference = gallery.put("b.exr", b);
  const nlohmann::json colour = comparison_of(run_program({"compare", picture_path, reference, "--json"}));
  for (const char* row : {"R", "G", "B", "all"}) {
    EXPECT_NEAR(colour["errors"][row]["mean_relative_error"].get<double>(), .1, 1e-6);
    EXPECT_NEAR(colour["errors"][row]["signed_mean"].get<double>(), .1, 1e-6);
    EXPECT_NEAR(colour["errors"][row]["relmse"].get<double>(), .01, 1e-6);
  }
  EXPECT_EQ(colour["errors"]["all"]["values"], 3 * kSize * kSize / 2);
  EXPECT_NEAR(colour["flip"]["exposure"].get<double>(), std::log2(1 / .4), 1e-6);
  const nlohmann::json diffuse =
      comparison_of(run_program({"compare", picture_path, reference, "--json", "--layer", "diffuse"}));
  EXPECT_NEAR(diffuse["errors"]["diffuse.G"]["signed_mean"].get<double>(), -.2, 1e-6);

  const Outcome text = run_program({"compare", picture_path, reference, "--exposure", "-1.5"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_TRUE(contains(text.out, "128 of 256 pixels")) << text.out;
  EXPECT_TRUE(contains(text.out, "10 %")) << text.out;
  EXPECT_TRUE(contains(text.out, "at -1.50 stops")) << text.out;
}

// Claim: above the bound in any channel is exit 1, with the figures on stdout and the reason on stderr; the
// bound is a percentage or a fraction. Source: the design exit codes. Fails if: "1%" is read as 1, or the
// mean over the channels (1 %) is looked at.
TEST(CliCompare, FailAbove) {
  const Gallery gallery;
  Image a = picture(1);
  for (std::size_t i = 2; i < a.pixels.size(); i += 7) a.pixels[i] *= 1.03f;
  const std::string worse = gallery.put("a.exr", a), reference = gallery.put("b.exr", picture(1));
  const std::vector<std::pair<std::string, int>> bounds{{"2%", 1},   {"2 %", 1},  {".02", 1},  {"0.02", 1},
                                                        {"3.1%", 0}, {".031", 0}, {"310%", 0}, {"0", 1}};
  for (const auto& [bound, exit_code] : bounds) {
    const Outcome outcome = run_program({"compare", worse, reference, "--fail-above", bound});
    EXPECT_EQ(outcome.exit_code, exit_code) << bound << outcome.err;
    EXPECT_EQ(contains(outcome.err, "mean relative error of B is 3 %"), exit_code == 1) << outcome.err;
    EXPECT_TRUE(contains(outcome.out, "relMSE"));
  }
  const Outcome json = run_program({"compare", worse, reference, "--fail-above", "2%", "--json"});
  EXPECT_EQ(json.exit_code, 1);
  EXPECT_TRUE(json.err.empty());
  const nlohmann::json result = comparison_of(json);
  EXPECT_FALSE(result["passed"]);
  EXPECT_EQ(result["failures"].size(), 1u);
  EXPECT_EQ(result["fail_above"], .02);
}

// Claim: NaN and infinities are counted apart in both pictures, wherever they are; in the picture they fail
// the comparison without any bound, in the reference they do not. Source: commands.h. Fails if: only the
// object is looked at (the NaN is off it), or the reference's count.
TEST(CliCompare, NonFiniteFails) {
  const Gallery gallery;
  Image a = picture(1), b = picture(1);
  a.pixels[a.pixels.size() - 7] = std::numeric_limits<float>::quiet_NaN();
  b.pixels[1] = b.pixels[7] = std::numeric_limits<float>::infinity();
  const std::string broken = put_raw(gallery.file("a.exr"), a), cracked = put_raw(gallery.file("b.exr"), b);
  const std::string whole = gallery.put("c.exr", picture(1));

  const Outcome failed = run_program({"compare", broken, cracked});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_TRUE(contains(failed.err, "1 values that are not finite")) << failed.err;
  EXPECT_TRUE(contains(failed.out, "1 NaN and 0 infinite values in " + broken)) << failed.out;
  EXPECT_TRUE(contains(failed.out, "0 NaN and 2 infinite values in " + cracked)) << failed.out;
  EXPECT_EQ(run_program({"compare", broken, "--halves", whole, whole}).exit_code, 1);

  const Outcome passed = run_program({"compare", whole, cracked, "--fail-above", "0", "--json"});
  EXPECT_EQ(passed.exit_code, 0);
  const nlohmann::json result = comparison_of(passed);
  EXPECT_EQ(result["not_finite"][1]["infinite"], 2);
  EXPECT_EQ(result["errors"]["R"]["values"], kSize * kSize / 2 - 1);
  EXPECT_EQ(result["errors"]["G"]["values"], kSize * kSize / 2 - 1);
  EXPECT_EQ(result["errors"]["B"]["values"], kSize * kSize / 2);
}

// Claim: what cannot be compared is exit 2, one line on stderr that names the file and both sides, nothing on
// stdout. Source: commands.h. Fails if: a check is left out (a crash, or figures of nothing).
TEST(CliCompare, WhatDoesNotFitIsNamed) {
  const Gallery gallery;
  const std::string a = gallery.put("a.exr", picture(1));
  Image small = picture(1), crop = picture(1), empty = picture(1), colourless = picture(1),
        broken = picture(1);
  small.width = kSize / 2;
  small.height = 2 * kSize;
  crop.crop_x = 3;
  crop.full_width = crop.full_height = 64;
  colourless.channels = {"Y", "U", "V", "A", "1", "2", "3"};
  for (std::size_t i = 3; i < empty.pixels.size(); i += 7) empty.pixels[i] = 0;
  for (std::size_t i = 1; i < broken.pixels.size(); i += 7)
    broken.pixels[i] = std::numeric_limits<float>::quiet_NaN();
  put_bytes(gallery.file("notes.exr"), "not a readable image");
  write_png(gallery.file("a.png"), picture(1), 0);
  const struct {
    std::vector<std::string> rest;
    std::string file;
    std::vector<std::string> named;
  } cases[] = {
      {{gallery.file("none.exr")}, "none.exr", {"no such image file"}},
      {{gallery.file("notes.exr")}, "notes.exr", {"not a readable image"}},
      {{gallery.put("small.exr", small)}, "a.exr", {"size", "8 x 32", "16 x 16", "small.exr"}},
      {{gallery.put("crop.exr", crop)}, "a.exr", {"crop", "3,0 of 64 x 64", "0,0 of 16 x 16", "crop.exr"}},
      {{gallery.put("empty.exr", empty)}, "empty.exr", {"no pixel shows an object"}},
      {{put_raw(gallery.file("colourless.exr"), colourless)},
       "colourless.exr",
       {"got R,G,B", "one of Y; A; "}},
      {{put_raw(gallery.file("broken.exr"), broken)}, "broken.exr", {"finite", "channel G"}},
      {{a, "--layer", "difuse"}, "a.exr", {"difuse", "R,G,B; A; diffuse"}},
      {{gallery.file("a.png"), "--layer", "diffuse"}, "a.png", {"got diffuse"}},
      {{"--halves", a, gallery.file("small.exr")}, "a.exr", {"size"}},
      {{"--halves", a, gallery.file("none.exr")}, "none.exr", {"no such image file"}},
  };
  for (const auto& c : cases) {
    std::vector<std::string> arguments{"compare", a};
    arguments.insert(arguments.end(), c.rest.begin(), c.rest.end());
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << c.rest[0];
    EXPECT_TRUE(outcome.err.starts_with("opaline: error: " + gallery.file(c.file))) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const std::string& named : c.named) EXPECT_TRUE(contains(outcome.err, named)) << outcome.err;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  }
  const Outcome json = run_program({"compare", a, gallery.file("none.exr"), "--json"});
  EXPECT_EQ(event_of(events_of(json.out), "error")["exit_code"], 2);
}

// Claim: a crop's EXR compares with its PNG, which knows no crop; a picture whose object is larger than the
// reference's is warned of. Source: compare_command.cpp. Fails if: a PNG is taken for a whole picture.
TEST(CliCompare, CropsInPngAndUncoveredPixels) {
  const Gallery gallery;
  Image crop = picture(.1f);
  crop.crop_x = 3;
  crop.full_width = crop.full_height = 64;
  const std::string exr = gallery.put("a.exr", crop), png = gallery.file("a.png");
  write_png(png, crop, 0);
  const Outcome outcome = run_program({"compare", exr, png, "--fail-above", "100%"});
  EXPECT_NE(outcome.exit_code, 2) << outcome.err;

  for (std::size_t i = 3; i < crop.pixels.size(); i += 7) crop.pixels[i] = 1;
  const Outcome larger = run_program({"compare", gallery.put("b.exr", crop), exr});
  EXPECT_EQ(larger.exit_code, 0);
  EXPECT_TRUE(contains(larger.err, "warning: 128 pixels show an object")) << larger.err;
}

// Claim: two halves give the error between them: by hand, for h = 1.1, d1 = .9, d2 = 1.1 of d = 1: err^2 = 0;
// for h = 1: -.01 / 1.0001, below noise; for h = 1.3: .4 x .2 / 1.0001, an error of 28.3 %, above a bound of
// 28 %. Tolerance: float rounding. Fails if: --fail-above looks at the error against d (30 %).
TEST(CliCompare, Halves) {
  const Gallery gallery;
  const std::string d1 = gallery.put("d1.exr", picture(.9f)), d2 = gallery.put("d2.exr", picture(1.1f));
  const auto compare = [&](float value, const std::string& bound, int exit_code) {
    const Outcome outcome = run_program({"compare", gallery.put("h.exr", picture(value)), "--halves", d1, d2,
                                         "--json", "--fail-above", bound});
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.out;
    return comparison_of(outcome)["errors"]["B"];
  };
  EXPECT_NEAR(compare(1.1f, "1%", 0)["squared_error"].get<double>(), 0, 1e-7);
  EXPECT_NEAR(compare(1.0f, "0", 0)["squared_error"].get<double>(), -.01 / 1.0001, 1e-7);
  EXPECT_TRUE(compare(1.0f, "0", 0)["below_noise"]);
  EXPECT_NEAR(compare(1.3f, "28%", 1)["error"].get<double>(), std::sqrt(.08 / 1.0001), 1e-6);
  EXPECT_NEAR(compare(1.3f, "29%", 0)["signed_mean"].get<double>(), .3, 1e-6);
  const std::string h = gallery.put("h.exr", picture(1));
  const Outcome text = run_program({"compare", h, "--halves", d1, d2});
  EXPECT_TRUE(contains(text.out, "R: below noise (-10 %)")) << text.out;
}

// Claim: the error picture is written in its format: the signed relative errors as an EXR at the place of the
// crop, colours as a PNG; the old file stays when the comparison is refused. Source: error_picture.h. Fails
// if: values are written as half floats, or before the checks.
TEST(CliCompare, ErrorPicture) {
  const Gallery gallery;
  Image crop = picture(.9f);
  crop.crop_y = 5;
  crop.full_width = crop.full_height = 64;
  const std::string a = gallery.put("a.exr", crop), exr = gallery.file("e.exr"), png = gallery.file("e.png");
  for (std::size_t i = 0; i < crop.pixels.size(); ++i)
    if (i % 7 != 3) crop.pixels[i] /= .9f;
  const std::string b = gallery.put("b.exr", crop);
  ASSERT_EQ(run_program({"compare", a, b, "--error-picture", exr}).exit_code, 0);
  ASSERT_EQ(run_program({"compare", a, b, "--error-picture", png}).exit_code, 0);
  const Image errors = read_image(exr);
  EXPECT_EQ(errors.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(errors.crop_y, 5);
  EXPECT_EQ(errors.full_width, 64);
  EXPECT_NEAR(errors.pixels[0], -.1, 1e-6);
  EXPECT_EQ(errors.pixels.back(), 0);  // no object there
  EXPECT_EQ(read_image(png).width, kSize);

  const std::string before = bytes_of(png);
  EXPECT_EQ(run_program({"compare", a, b, "--layer", "none", "--error-picture", png}).exit_code, 2);
  EXPECT_EQ(bytes_of(png), before);
  EXPECT_EQ(run_program({"compare", a, b, "--error-picture", gallery.file("no/e.png")}).exit_code, 3);
}

}  // namespace
}  // namespace opaline
