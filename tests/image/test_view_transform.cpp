// SPDX-License-Identifier: GPL-3.0-or-later
// What a screen shows of bright light.
#include <gtest/gtest.h>

#include <cmath>

#include "../core/scratch_folder.h"
#include "image/view_transform.h"
#include "opaline/image.h"

namespace opaline {
namespace {

constexpr ViewTransform kBending[] = {ViewTransform::soft, ViewTransform::neutral, ViewTransform::agx};

void expect_color(const RgbF& color, const Vec3d& wanted, double tolerance) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(double(color[c]), wanted[c], tolerance) << c;
}

// Claim: soft and srgb leave colours whose channels are below .8 as they are, to the bit. Fails if soft takes something
// off everywhere, as neutral does.
TEST(ViewTransform, SoftLeavesWhatIsBelowPointEight) {
  for (const RgbF& color : {RgbF{0, 0, 0}, RgbF{.18f, .5f, .03f}, RgbF{.799f, .1f, .799f}})
    for (const ViewTransform view : {ViewTransform::soft, ViewTransform::srgb})
      EXPECT_EQ(shown_color(view, color), color);
}

// Claim: neutral is the published formula. Source: Khronos PBR Neutral specification, worked by hand: 1 loses .04, and
// .96 becomes 1 - .24^2 / .44; a red of 10 becomes 1 - .24^2 / 9.48, and 1 - 1 / (1 + .15 x 9.006) of it white.
// Fails if the toe, the shoulder or the loss of colour is left out.
TEST(ViewTransform, KhronosNeutral) {
  expect_color(shown_color(ViewTransform::neutral, RgbF(1)), Vec3d(1 - .0576 / .44), 1e-6);
  expect_color(shown_color(ViewTransform::neutral, {.5f, .3f, .2f}), {.46, .26, .16}, 1e-6);
  expect_color(shown_color(ViewTransform::neutral, RgbF(.04f)), Vec3d(.01), 1e-6);
  const double peak = 1 - .0576 / 9.48, white = 1 - 1 / (1 + .15 * (10 - peak));
  expect_color(shown_color(ViewTransform::neutral, {10, 0, 0}), {peak, peak * white, peak * white}, 1e-6);
}

// Claim: agx shows middle grey at half the screen's signal, black and its brightest stop at the ends, and a bright red
// towards white. Source: AgX's base contrast, pivot (.606, .5). Tolerance: the polynomial's error, .02. Fails if the
// matrices are transposed (greys are then tinted) or the range of stops is another.
TEST(ViewTransform, Agx) {
  const auto signal = [](const RgbF& color) { return std::pow(double(color.x), 1 / 2.2); };
  const RgbF grey = shown_color(ViewTransform::agx, RgbF(.18f));
  EXPECT_NEAR(signal(grey), .5, .02);
  EXPECT_NEAR(double(grey.x), double(grey.y), 1e-3);
  EXPECT_NEAR(double(grey.x), double(grey.z), 1e-3);
  EXPECT_LT(signal(shown_color(ViewTransform::agx, RgbF(0))), .01);
  EXPECT_NEAR(signal(shown_color(ViewTransform::agx, RgbF(float(std::exp2(4.026069))))), 1, .02);
  const RgbF red = shown_color(ViewTransform::agx, {50, 0, 0});
  EXPECT_GT(double(min_component(red)), .2);
  EXPECT_LT(double(red.y), double(red.x));
}

// Claim: what is brighter is shown brighter, below 1, up to 30 times white in soft and neutral and 16 in agx; srgb cuts
// at 1. Fails if a shoulder is missing.
TEST(ViewTransform, HighlightsAreNotCut) {
  for (const ViewTransform view : kBending) {
    float before = -1;
    for (float light = .01f; light < (view == ViewTransform::agx ? 15.9f : 30.f); light *= 1.2f) {
      const RgbF shown = shown_color(view, {light, .6f * light, .3f * light});
      EXPECT_GT(shown.x, before) << int(view) << ' ' << light;
      EXPECT_LT(shown.x, 1) << int(view) << ' ' << light;
      EXPECT_GE(shown.y, shown.z);
      before = shown.x;
    }
  }
  EXPECT_EQ(shown_color(ViewTransform::srgb, {30, .5f, 0}), (RgbF{1, .5f, 0}));
}

// Claim: a PNG has what the view shows: highlights of 1.5 and 3 are the same white in srgb, and two in the others; what
// is not finite is black in all. Source: image.h. Fails if write_png passes the view over.
TEST(ViewTransform, InThePng) {
  const ScratchFolder folder;
  Image image;
  image.width = 3;
  image.height = 1;
  image.channels = {"R", "G", "B"};
  image.pixels.assign({1.5f, 1.5f, 1.5f, 3, 3, 3, INFINITY, NAN, -1});
  for (const ViewTransform view :
       {ViewTransform::soft, ViewTransform::neutral, ViewTransform::agx, ViewTransform::srgb}) {
    write_png(folder.file("a.png"), image, 0, view);
    const Image shown = read_image(folder.file("a.png"));
    EXPECT_EQ(shown.pixels[0] < shown.pixels[3], view != ViewTransform::srgb) << int(view);
    for (std::size_t c = 6; c < 9; ++c) EXPECT_LT(shown.pixels[c], 1e-3f) << int(view);
  }
}

}  // namespace
}  // namespace opaline
