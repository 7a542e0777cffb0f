// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures mixed from those by single lights, of a renderer that only adds up colours.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "opaline/lights/light.h"
#include "opaline/render/layers.h"
#include "session/light_mix.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

Image sum_of_colours(const Scene& scene) {
  Image image;
  image.width = image.height = 1;
  image.channels = {"R", "G", "B"};
  RgbF sum;
  for (const Light& light : scene.lights) sum += RgbF(emission(light));
  image.pixels.assign({sum.x, sum.y, sum.z});
  return image;
}

Scene coloured(double first, double second, double third) {
  Scene scene;
  for (const double power : {first, second, third})
    scene.lights.push_back(point_light({0, 9, 0}, {power, 2 * power, 3 * power}));
  return scene;
}

/// The red of the picture, mixed or rendered.
float red(LightMix& mix, const Scene& scene, const LightMix::Render& render = sum_of_colours) {
  const std::optional<Image> mixed = mix.mixed(scene, render);
  return (mixed ? *mixed : render(scene)).pixels[0];
}

// Claim: a part that fails (interrupted, out of memory) leaves nothing half done: later pictures are right.
// Fails if: the lights of the failed edit count as known, or the picture of the others holds their old
// colours.
TEST(LightMix, FailedPartLeavesNothing) {
  for (int failing = 1; failing <= 2; ++failing) {
    LightMix mix;
    red(mix, coloured(1, 1, 1));
    red(mix, coloured(2, 1, 1));
    int calls = 0;
    const auto fails = [&](const Scene& scene) {
      if (++calls == failing) throw std::runtime_error("full");
      return sum_of_colours(scene);
    };
    EXPECT_THROW(mix.mixed(coloured(3, 1, 1), fails), std::runtime_error);
    for (const double power : {3., 4., 5., 6.}) EXPECT_EQ(red(mix, coloured(power, 1, 1)), power + 2);
  }
}

// Claim: made ready before, the first edit of colours is a sum, of whichever light, a light that was black
// among them; the same scene again is not. Fails if: a light that was off has no picture, or the first edit
// renders.
TEST(LightMix, MadeReadyBefore) {
  for (std::size_t edited = 0; edited < 3; ++edited) {
    LightMix mix;
    Scene scene = coloured(1, 0, 4);
    red(mix, scene);
    mix.get_ready(scene, sum_of_colours);
    EXPECT_FALSE(mix.mixed(scene, sum_of_colours));
    const double before = double(sum_of_colours(scene).pixels[0]);
    const Rgb colour = emission(scene.lights[edited]);
    std::get<PointLight>(scene.lights[edited].source).intensity.x = colour.x + 7;
    const auto none = [](const Scene&) -> Image { throw std::runtime_error("rendered"); };
    EXPECT_EQ(red(mix, scene, none), before + 7);
  }
}

// Claim: where one picture more has no room, everything is let go of. Fails if: the light that had none keeps
// its old colour in the picture of the others.
TEST(LightMix, NoRoomForOneMore) {
  const double pixel = double(layer_names(Method::hierarchical).size() * sizeof(float));
  const int side = int(std::sqrt(double(kMostMixBytes) / (3.5 * pixel)));
  const auto large = [&](double first, double second) {
    Scene scene = coloured(first, second, 1);
    scene.film.resolution = {side, side};
    return scene;
  };
  LightMix mix;
  for (const double power : {1., 2., 3., 4.}) EXPECT_EQ(red(mix, large(power, 1)), power + 2);
  EXPECT_EQ(red(mix, large(4, 7)), 12);
  for (const double power : {5., 6., 7., 8.}) EXPECT_EQ(red(mix, large(power, 7)), power + 8);
}

}  // namespace
}  // namespace opaline::test
