// SPDX-License-Identifier: GPL-3.0-or-later
// Camera rays by the error of their pixels: noise, bias, layers.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/adaptive_rays.h"
#include "render/mattes.h"
#include "session/light_groups.h"
#include "support/scenes.h"

namespace opaline {
namespace {

using namespace test;

constexpr const char* kColors[] = {"R", "G", "B"};

/// A bright ball and a dark one before a wall, with edges, soft shadows and highlights.
Scene balls_before_wall(double until_error, std::uint64_t seed = 0) {
  Scene scene = single_shape(SphereShape{{-8, 0, 0}, 8}, marble(), 200);
  scene.media[0].specular_roughness = .3;
  scene.shapes.push_back(translucent("other", SphereShape{{9, 0, 0}, 8}));
  scene.shapes[1].medium.reset();
  scene.shapes[1].reflectance = {.02, .03, .05};
  Shape wall;
  wall.name = "wall";
  wall.source = QuadShape{{-20, -20, -30}, {40, 0, 0}, {0, 40, 0}};
  scene.shapes.push_back(wall);
  scene.lights = {{"lamp", SphereLight{{40, 60, 50}, 12, Rgb(1)}},
                  point_light({-30, 10, 40}, {90, 100, 150})};
  scene.film.resolution = {40, 40};
  scene.settings.method = Method::lambert;
  scene.settings.light_samples = 8;
  scene.settings.bounces = 0;
  scene.settings.until_error = until_error;
  scene.settings.seed = seed;
  return scene;
}

RenderResult rendered(const Scene& scene) {
  Session session;
  session.edit(scene);
  return session.render();
}

std::vector<double> values_of(const Image& image, const std::string& name) {
  std::vector<double> values;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) values.push_back(double(channel(image, x, y, name)));
  return values;
}

/// Square of RelativeNoise of one image, from its reference.
double squared_noise(const Image& image, const Image& reference) {
  double worst = 0;
  for (const char* name : kColors) {
    const std::vector<double> a = values_of(image, name), b = values_of(reference, name);
    std::vector<double> sorted;
    std::ranges::copy_if(b, std::back_inserter(sorted), [](double value) { return value > 0; });
    std::ranges::sort(sorted);
    const double floor = .01 * sorted[std::size_t(.99 * double(sorted.size() - 1))];
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += (a[i] - b[i]) * (a[i] - b[i]) / (b[i] * b[i] + floor * floor);
    worst = std::max(worst, sum / double(sorted.size()));
  }
  return worst;
}

// Claim: the noise of an image is the stated one, at most until_error, and further images with other seeds have the mean of the
// converged image: all of it within 0.1 %, pixels with an edge within 0.3 %. Source: the reference by 1/8 of the error. Tolerance: the
// stated noise exceeds that of edges by up to a third (adaptive_rays.h); five standard errors of the means. Fails if: the
// change of single pixels decides in place of the variance over their rays, the change is not halved, or the means are
// over film.samples_per_pixel.
TEST(AdaptiveRays, NoiseIsTheStatedOneWithoutBias) {
  constexpr double kUntil = .04;
  constexpr int kSeeds = 16;
  const Image reference = rendered(balls_before_wall(kUntil / 8, 99)).image;
  double squares = 0, stated = 0;
  std::vector<double> sum(std::size_t(reference.width) * std::size_t(reference.height));
  for (int seed = 0; seed < kSeeds; ++seed) {
    const RenderResult result = rendered(balls_before_wall(kUntil, std::uint64_t(seed)));
    EXPECT_FALSE(result.adaptive.has_reached_most);
    EXPECT_LE(result.adaptive.noise, kUntil);
    stated += result.adaptive.noise * result.adaptive.noise / kSeeds;
    squares += squared_noise(result.image, reference) / kSeeds;
    const std::vector<double> green = values_of(result.image, "G");
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += green[i] / kSeeds;
  }
  const double ratio = std::sqrt(squares / stated);
  EXPECT_GT(ratio, .6);
  EXPECT_LT(ratio, 1.15);
  const std::vector<double> wanted = values_of(reference, "G");
  double all = 0, all_wanted = 0, edges = 0, edges_wanted = 0;
  for (int y = 1; y + 1 < reference.height; ++y)
    for (int x = 1; x + 1 < reference.width; ++x) {
      const auto i = std::size_t(y) * std::size_t(reference.width) + std::size_t(x);
      const auto [low, high] =
          std::minmax({wanted[i - 1], wanted[i + 1], wanted[i - std::size_t(reference.width)],
                       wanted[i + std::size_t(reference.width)]});
      all += sum[i];
      all_wanted += wanted[i];
      if (high < 2 * low) continue;
      edges += sum[i];
      edges_wanted += wanted[i];
    }
  ASSERT_GT(edges_wanted, 0);
  EXPECT_NEAR(all / all_wanted, 1, .001);
  EXPECT_NEAR(edges / edges_wanted, 1, .003);
}

// Claim: pixels without an edge have few rays, those at edges more, and the rays end far below those of a uniform image of this
// noise. Source: by hand. Fails if: all pixels continue alike.
TEST(AdaptiveRays, EdgesHaveMoreRays) {
  const AdaptiveRays adaptive = rendered(balls_before_wall(.02)).adaptive;
  const double mean = double(std::accumulate(adaptive.rays.begin(), adaptive.rays.end(), std::size_t(0))) /
                      double(adaptive.rays.size());
  const int most = *std::ranges::max_element(adaptive.rays);
  EXPECT_EQ(*std::ranges::min_element(adaptive.rays), kFewestAdaptiveRays);
  EXPECT_GE(most, 64);
  EXPECT_LT(mean, .4 * most);
}

// Claim: the image has the same bits with one thread and with four, in a crop of whole tiles too, and its number of camera rays per
// pixel in the film has no effect. Source: the design. Fails if: sums or choices depend on the order of tiles.
TEST(AdaptiveRays, BitsDoNotDependOnThreads) {
  Scene scene = balls_before_wall(.05);
  const RenderResult wanted = rendered(scene);
  for (const std::size_t threads : {1, 4}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    scene.film.samples_per_pixel *= 4;
    const RenderResult result = rendered(scene);
    EXPECT_EQ(result.adaptive.rays, wanted.adaptive.rays);
    EXPECT_TRUE(result.image.pixels == wanted.image.pixels);
  }
}

// Claim: with unequal rays per pixel, the mattes of a pixel add up to its alpha, light groups to the image, depth and
// irradiance stay between those of its surfaces. Source: their definitions. Tolerance: float rounding. Fails if: mattes or
// groups have the rays of the film, or a layer is divided by another count.
TEST(AdaptiveRays, LayersHaveTheSameRays) {
  Session session;
  Scene scene = balls_before_wall(.05);
  scene.shapes.pop_back();  // edges before nothing
  session.edit(scene);
  const RenderResult result = session.render();
  Image image = result.image;
  add_light_groups(session, image);
  EXPECT_TRUE(std::ranges::equal(session.adaptive_rays(), result.adaptive.rays));
  add_mattes(
      {session.scene(), session.world(), session.rays(), {}, nullptr, nullptr, {}, session.adaptive_rays()},
      image);
  int partial = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float alpha = channel(image, x, y, "A");
      partial += alpha > 0 && alpha < 1 ? 1 : 0;
      float covered = 0;
      for (const char* rank : {"00.G", "00.A", "01.G", "01.A"})
        covered += channel(image, x, y, std::string("CryptoObject") + rank);
      EXPECT_NEAR(covered, alpha, 1e-6f) << x << ' ' << y;
      for (const std::string color : kColors) {
        float sum = 0;
        for (const char* group :
             {"diffuse_lamp.", "specular_lamp.", "emission_lamp.", "diffuse_point.", "specular_point."})
          sum += channel(image, x, y, group + color);
        EXPECT_NEAR(sum, channel(image, x, y, color), 3e-6f * sum) << x << ' ' << y;
      }
      const float depth = channel(image, x, y, "Z");
      EXPECT_TRUE(alpha == 0 ? depth == 0 : depth > 91 && depth < 101) << depth;
    }
  EXPECT_GT(partial, 20);
  EXPECT_FALSE(std::ranges::equal(
      std::vector<std::uint16_t>(result.adaptive.rays.size(), kFewestAdaptiveRays), result.adaptive.rays));
}

// Claim: light groups of an adaptive image equal images by one light with the same rays, before they are scaled to the sum: their
// factors are within 1e-5 of 1. Source: the image is linear in its lights. Fails if: a group has rays of its own.
TEST(AdaptiveRays, LightGroupsRepeatTheRays) {
  Session session;
  const Scene scene = balls_before_wall(.05);
  session.edit(scene);
  const RenderResult whole = session.render();
  session.repeat_adaptive_rays(true);
  std::vector<float> sum(whole.image.pixels.size());
  for (std::size_t light = 0; light < 2; ++light) {
    Scene alone = scene;
    alone.lights[1 - light] = with_emission(alone.lights[1 - light], {});
    session.edit(alone);
    const RenderResult result = session.render();
    EXPECT_EQ(result.adaptive.rays, whole.adaptive.rays);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += result.image.pixels[i];
  }
  const std::size_t channels = whole.image.channels.size();
  for (std::size_t i = 0; i < sum.size(); i += channels)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(sum[i + c], whole.image.pixels[i + c], 1e-5f * sum[i + c]);
}

// Claim: the layer `error` has the antialiasing of diffuse: at edges, its rms is that of the differences from the converged image
// of the same samples, beyond the layer there. The settings' own error is stated apart. Source: the reference by 1/8 of the error. Tolerance: edges count
// for more than they differ by up to a half. Fails if: the layer is that of the settings alone, or of a sum.
TEST(AdaptiveRays, ErrorLayerIncludesAntialiasing) {
  Scene scene = balls_before_wall(.1);
  scene.shapes.pop_back();  // even samples resolve the wall's upright edges far better
  scene.settings.method = Method::hierarchical;
  const RenderResult result = rendered(scene);
  EXPECT_EQ(settings_error(result), result.adaptive.settings_error);
  EXPECT_GT(settings_error(result), 0);
  scene.settings.until_error = .0125;
  const RenderResult reference = rendered(scene);
  const std::vector<double> value = values_of(result.image, "diffuse.G"),
                            wanted = values_of(reference.image, "diffuse.G"),
                            error = values_of(result.image, "error.G"),
                            settings = values_of(reference.image, "error.G"),
                            alpha = values_of(reference.image, "A");
  double stated = 0, squares = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!(alpha[i] > 0 && alpha[i] < 1)) continue;
    stated += error[i] * error[i] - settings[i] * settings[i];
    squares += (value[i] - wanted[i]) * (value[i] - wanted[i]);
  }
  EXPECT_GT(std::sqrt(stated / squares), .8);
  EXPECT_LT(std::sqrt(stated / squares), 1.5);
}

// Claim: a bound of rays ends the image above an error out of reach, and the result says so; without lights nothing is adaptive.
// Source: adaptive_rays.h. Fails if: the loop continues or the flag is missing.
TEST(AdaptiveRays, ABoundEndsThem) {
  Scene scene = balls_before_wall(1e-7);
  scene.film.resolution = {3, 3};
  scene.settings.light_samples = 1;
  const AdaptiveRays adaptive = rendered(scene).adaptive;
  EXPECT_TRUE(adaptive.has_reached_most);
  EXPECT_GT(adaptive.noise, 1e-7);
  EXPECT_EQ(*std::ranges::max_element(adaptive.rays), kMostAdaptiveRays);
  scene.lights.clear();
  EXPECT_TRUE(rendered(scene).adaptive.rays.empty());
}

}  // namespace
}  // namespace opaline
