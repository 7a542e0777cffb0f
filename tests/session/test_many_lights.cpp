// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of scenes with many lights, of which each point draws a few.
#include <tbb/global_control.h>

#include "core/random.h"
#include "lights/light.h"
#include "opaline/compare.h"
#include "session/light_groups.h"
#include "session_test.h"
#include "support/statistics.h"

namespace opaline {
namespace {

using namespace test;

/// Bulbs around the balls and above the floor, most of them dim, all of one flux together; as lamps of 1 mm radius too.
std::vector<Light> bulbs(std::size_t count, bool have_area = false) {
  std::vector<Light> lights;
  Rgb sum{};
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto at = [&](std::uint64_t k) { return unit_double(hash_bits(k, i)); };
    const double angle = 2 * kPi * at(1), away = 45 + 100 * at(2);
    const Vec3d place{away * std::cos(angle), 5 + 90 * at(3), away * std::sin(angle)};
    const Rgb colour = Rgb{.5 + at(4), .5 + at(5), .5 + at(6)} * std::exp(4 * at(7));
    sum += colour;
    const std::string name = "bulb" + std::to_string(i);
    if (have_area)
      lights.push_back({name, SphereLight{place, 1, colour}});
    else
      lights.push_back({name, PointLight{place, colour}});
  }
  const double scale = (have_area ? 1 / kPi : 1) * 3e5 / (sum.x + sum.y + sum.z);
  for (Light& light : lights) light = with_emission(light, emission(light) * scale);
  return lights;
}

Scene lit_by(std::vector<Light> lights) {
  Scene scene = two_balls();
  for (std::size_t ball = 0; ball < 2; ++ball)
    std::get<SphereShape>(scene.shapes[ball].source).fineness = kLeastFineness;
  scene.lights = std::move(lights);
  scene.settings.light_samples = 64;
  scene.settings.samples = 1000;
  return scene;
}

/// With a shadow ray to each of so many lights from all samples and pixels.
Scene traced_all(Scene scene) {
  scene.settings.light_samples = 3 * int(scene.lights.size());
  return scene;
}

RenderResult rendered(const Scene& scene) {
  Session session;
  session.edit(scene);
  return session.render();
}

// Claim: with as many shadow rays as lights a picture of 60 is the sum of pictures of 15. Source: light is linear.
// Tolerance: a mean of .5 %, the evaluator's. Fails when: a light is lost where they become a tree, or counts twice.
TEST(ManyLights, AddUpInAPicture) {
  const Scene all = lit_by(bulbs(60));
  Image sum;
  for (std::size_t first = 0; first < 60; first += 15) {
    Scene part = all;
    part.lights.assign(all.lights.begin() + std::ptrdiff_t(first),
                       all.lights.begin() + std::ptrdiff_t(first) + 15);
    const Image picture = cold_picture(part);
    if (sum.pixels.empty())
      sum = picture;
    else
      for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += picture.pixels[i];
  }
  EXPECT_LT(difference(cold_picture(traced_all(all)), sum), .005);
}

struct Off {
  double mean, p99, largest;
};
Off off(const RenderResult& picture, const Image& reference) {
  const RelativeErrors errors = relative_errors(extract_layer(picture.image, "diffuse"),
                                                extract_layer(reference, "diffuse"), picture.translucent);
  Off worst{};
  for (const std::vector<double>& channel : errors.channels) {
    const ErrorStatistics off = error_statistics(channel);
    worst = {std::max(worst.mean, off.mean), std::max(worst.p99, off.p99),
             std::max(worst.largest, off.largest)};
  }
  return worst;
}

// Claim: 1000 lights take at most three times the shadow rays of 10, and the balls are off the picture of all by 4 % in
// the mean, 15 % at the p99 and 35 % at most. Source: measured, 3.1 %, 11 %, 24 %. Fails when: a pixel is lit by a light
// that it had hardly a chance to draw, or draws are with replacement.
TEST(ManyLights, CostWhatFewDo) {
  const auto rays_of = [](const Scene& scene) {
    Session session;
    session.edit(scene);
    session.render();
    return double(session.rays().statistics().rays);
  };
  const Scene scene = lit_by(bulbs(1000));
  EXPECT_LT(rays_of(scene), 3 * rays_of(lit_by(bulbs(10))));
  const Off measured = off(rendered(scene), rendered(traced_all(scene)).image);
  EXPECT_LT(measured.mean, .04);
  EXPECT_LT(measured.p99, .15);
  EXPECT_LT(measured.largest, .35);
}

// Claim: the estimated error of a picture is within a factor 2 of the measured one, with few rays and more. Source: the
// statement in render.h. The reference has ten times the samples of another seed, and all lights. Fails when: the noise of
// drawing is left out, or lights that are drawn surely count to it.
TEST(ManyLights, ErrorIsKnown) {
  Scene scene = lit_by(bulbs(200));
  scene.shapes.erase(scene.shapes.begin() + 1);
  scene.settings.samples = 1500;
  Scene truth = traced_all(scene);
  truth.settings.samples = 15'000;
  truth.settings.seed = 5;
  const Image reference = rendered(truth).image;
  for (const int light_samples : {16, 64}) {
    scene.settings.light_samples = light_samples;
    const RenderResult result = rendered(scene);
    const double measured = off(result, reference).mean,
                 estimated = estimated_relative_error(result.image, result.translucent);
    EXPECT_LT(std::abs(std::log(estimated / measured)), std::log(2)) << estimated << ' ' << measured;
  }
}

// Claim: a session that lost, moved or recoloured one of many lights makes the picture of a new one; a moved camera traces
// no light again. Source: session.h. Tolerance: none. Fails when: the key of a tree leaves a light's place or colour out.
TEST(ManyLights, EditsAreSeen) {
  Scene scene = lit_by(bulbs(40));
  scene.settings.samples = 300;
  scene.film.resolution = {24, 16};
  Session session;
  session.hold_view(true);
  picture_of(session, scene);
  const auto expect_anew = [&](const char* what) {
    EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene))) << what;
  };
  std::get<PointLight>(scene.lights[7].source).position.y += 20;
  expect_anew("moved");
  scene.lights[9] = with_emission(scene.lights[9], Rgb(900));
  expect_anew("recoloured");
  scene.lights.pop_back();
  expect_anew("lost");
  scene.camera.position.x += 5;
  expect_anew("camera");
  EXPECT_EQ(session.work().lights_traced, 0u);
  scene.lights.resize(10);
  expect_anew("few");
}

/// Over seeds, of what the boundaries mirror of lights together.
Mean mirrored(Scene scene) {
  Mean mean;
  for (scene.settings.seed = 0; scene.settings.seed < 10; ++scene.settings.seed) {
    const Image picture = cold_picture(scene);
    double sum = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) sum += double(channel(picture, x, y, "specular.G"));
    mean.add(sum);
  }
  return mean;
}

// Claim: a rough coat mirrors many bulbs and lamps as it does each by itself, in the mean over seeds. Source: a way of
// drawing stands for 1 / its density. Tolerance: 4 standard errors of 10 seeds, below 6 % of the sum. Fails when:
// bulbs, which no ray of the lobe can meet, share with the lobe; or lamps count both ways in full.
TEST(ManyLights, AreMirrored) {
  for (const bool have_area : {false, true}) {
    Scene scene = lit_by(bulbs(32, have_area));
    scene.shapes.resize(1);
    scene.media[0].specular_roughness = .4;
    scene.settings.method = Method::lambert;
    scene.film.resolution = {24, 16};
    const Mean drawn = mirrored(scene);
    double each = 0, squares = drawn.error() * drawn.error();
    for (const std::ptrdiff_t first : {0, 16}) {
      Scene part = scene;
      part.lights = {scene.lights.begin() + first, scene.lights.begin() + first + 16};
      const Mean mean = mirrored(part);
      each += mean.mean();
      squares += mean.error() * mean.error();
    }
    EXPECT_LT(std::abs(drawn.mean() - each), 4 * std::sqrt(squares))
        << have_area << ": " << drawn.mean() << ' ' << each;
    EXPECT_LT(std::sqrt(squares), .06 * each) << have_area;
  }
}

// Claim: groups of many lights sum to the picture, whether a group has many or few. Source: light_groups.h. Tolerance:
// rounding of floats. Fails when: lights that a group leaves out are traced, drawn or lost with those of other groups.
TEST(ManyLights, GroupsSumToThePicture) {
  Scene scene = lit_by(bulbs(50));
  for (std::size_t l = 0; l < 50; ++l) scene.lights[l].name = l < 5 ? "few" : "many";
  scene.settings.samples = 300;
  scene.film.resolution = {24, 16};
  Session session;
  session.edit(scene);
  Image picture = session.render().image;
  add_light_groups(session, picture);
  double few = 0, whole = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const float diffuse = channel(picture, x, y, "diffuse.G"),
                  part = channel(picture, x, y, "diffuse_few.G");
      EXPECT_NEAR(part + channel(picture, x, y, "diffuse_many.G"), diffuse, 3e-6f * diffuse);
      few += double(part);
      whole += double(diffuse);
    }
  scene.lights.resize(5);
  const Image alone = cold_picture(scene);
  double expected = 0;
  for (int y = 0; y < alone.height; ++y)
    for (int x = 0; x < alone.width; ++x) expected += double(channel(alone, x, y, "diffuse.G"));
  EXPECT_GT(whole, 1.5 * expected);
  EXPECT_NEAR(few / expected, 1, .03);
}

// Claim: a picture of many lights has the same bytes on one thread and three, rough coats, lamps and light that bounces
// included. Source: the project's promise. Tolerance: none. Fails when: draws hang on the order of the points.
TEST(ManyLights, PicturesAreTheSameForAnyThreads) {
  Scene scene = lit_by(bulbs(40));
  for (const Light& lamp : bulbs(20, true)) scene.lights.push_back(lamp);
  scene.media[0].specular_roughness = .4;
  scene.settings.samples = 300;
  scene.settings.bounces = 1;
  scene.film.resolution = {24, 16};
  std::vector<Image> pictures;
  for (const std::size_t threads : {1, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    pictures.push_back(cold_picture(scene));
  }
  EXPECT_TRUE(same_pixels(pictures[0], pictures[1]));
}

}  // namespace
}  // namespace opaline
