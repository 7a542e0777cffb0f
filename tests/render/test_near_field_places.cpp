// SPDX-License-Identifier: GPL-3.0-or-later
// What the places beside shadow edges cost, and the noise that they leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "render/shade.h"
#include "render/tile_renderer.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

/// Rays of the picture besides those that one with its points' own irradiance traces: one for each place and
/// one from it to each light. fill: intensity of a light beside the camera, in whose light nothing has
/// shadows
double place_rays(int side, double fill = 0) {
  Scene scene = single_shape(TorusShape{{}, 20, 8}, marble(), 8000);
  scene.lights = {point_light({30, 60, 40}, {9000, 8000, 7000})};
  if (fill > 0) scene.lights.push_back(point_light({0, 50, 90}, {fill, fill, fill}));
  scene.camera.position = {0, 50, 90};
  scene.film.resolution = {side, side};
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  const auto rays_of = [&](NearIrradiance near) {
    scene.settings.laboratory.near_irradiance = near;
    const Prepared prepared(scene);
    const std::uint64_t before = prepared.rays.statistics().rays;
    prepared.picture();
    return double(prepared.rays.statistics().rays - before);
  };
  return rays_of(NearIrradiance::mixed) - rays_of(NearIrradiance::point);
}

struct Noise {
  double rms = 0, p99 = 0;  ///< over the pixels that show light, relative, of green
  double rays = 0;          ///< of a picture
};

/// By pictures that differ by their random numbers alone: a point light has none but those of the places.
/// side: of the picture, pixels
Noise place_noise(int side) {
  Scene scene = single_shape(TorusShape{{}, 20, 8}, marble(), 8000);
  scene.media[0].profile = ProfileKind::normalized_diffusion;
  scene.media[0].fit = NormalizedDiffusionFit::diffuse_entry;
  scene.lights = {point_light({30, 60, 40}, {9000, 8000, 7000})};
  scene.camera.position = {0, 50, 90};
  scene.film.resolution = {side, side};
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  const Prepared prepared(scene);
  const std::uint64_t before = prepared.rays.statistics().rays;
  constexpr std::size_t kPictures = 8;
  // The samples stay: they have been placed.
  std::vector<Scene> scenes(kPictures, prepared.scene);
  std::vector<RenderInput> inputs;
  std::vector<std::unique_ptr<Shader>> shaders;
  for (std::size_t k = 0; k < kPictures; ++k) {
    scenes[k].settings.seed = k;
    inputs.push_back({scenes[k], prepared.world, prepared.rays, prepared.bodies});
  }
  for (const RenderInput& input : inputs) shaders.push_back(std::make_unique<Shader>(input));
  std::vector<double> deviations;
  Noise noise;
  for (const Rectangle& tile : tiles_of(scene.film)) {
    std::vector<double> sums, squares;
    for (std::size_t k = 0; k < kPictures; ++k) {
      const std::vector<PixelSample> pixels = TileRenderer(inputs[k], *shaders[k]).render(tile, {}).sums;
      sums.resize(pixels.size());
      squares.resize(pixels.size());
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double light = double(pixels[i].diffuse.y);
        sums[i] += light / kPictures;
        squares[i] += light * light / kPictures;
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
      if (sums[i] > 0) deviations.push_back(std::sqrt(std::max(0.0, squares[i] / (sums[i] * sums[i]) - 1)));
  }
  std::ranges::sort(deviations);
  for (const double deviation : deviations) noise.rms += deviation * deviation / double(deviations.size());
  noise.rms = std::sqrt(noise.rms);
  noise.p99 = deviations[deviations.size() * 99 / 100];
  noise.rays = double(prepared.rays.statistics().rays - before) / kPictures;
  return noise;
}

// Claim: neighbours' places fill each other's gaps, and are so many that p99 of their noise is 2.2 %. Source:
// near_field_sampler.h. Tolerance: a tenth above the measured rms of .0041 and p99 of .0217. Fails if: they
// take the same ones of the sequence (rms .012), are half as many together (.0049, .0247), or another seed
// draws the same (0).
TEST(NearFieldPlaces, FillEachOthersGaps) {
  const Noise noise = place_noise(192);
  RecordProperty("rms", std::to_string(noise.rms));
  RecordProperty("p99", std::to_string(noise.p99));
  EXPECT_LT(noise.rms, .0045);
  EXPECT_LT(noise.p99, .024);
  EXPECT_GT(noise.rms, .001);
}

// Claim: where pixels lie close together, the lattice that they share leaves less noise than places of their
// own. Source: near_field_sampler.h. Tolerance: a fifth above the measured rms of .0028 and p99 of .0139. Fails
// if: the points draw places of their own (rms .0058, p99 .0279).
TEST(NearFieldPlaces, AreOfALatticeWherePixelsAreClose) {
  const Noise noise = place_noise(768);
  RecordProperty("rms", std::to_string(noise.rms));
  RecordProperty("p99", std::to_string(noise.p99));
  EXPECT_LT(noise.rms, .0034);
  EXPECT_LT(noise.p99, .0167);
}

// Claim: where light from elsewhere hides an edge, fewer places do. Tolerance: measured .85 of them. Fails
// if: the stakes are not looked at (.91: fewer points have places at all).
TEST(NearFieldPlaces, AreFewerWhereLessIsAtStake) {
  const double hidden = place_rays(128, 300) / 3, plain = place_rays(128, 0) / 2;
  EXPECT_GT(hidden, .5 * plain);
  EXPECT_LT(hidden, .875 * plain);
}

// Claim: another seed has other places, which is how probes tell their noise. Source: probe.h. Fails if: the
// places hang on the pixels alone (0).
TEST(NearFieldPlaces, AreTheSeedsOwn) {
  Scene scene = single_shape(TorusShape{{}, 20, 8}, marble(), 2000);
  scene.lights = {point_light({30, 60, 40}, {9000, 8000, 7000})};
  scene.camera.position = {0, 50, 90};
  scene.film.resolution = {32, 32};
  const Prepared prepared(scene);
  const Image one = prepared.picture();
  EXPECT_EQ(prepared.picture().pixels, one.pixels);
  scene.settings.seed = 7;
  EXPECT_NE(render({scene, prepared.world, prepared.rays, prepared.bodies}).image.pixels, one.pixels);
}

// Claim: neighbours share their places: 16 times the pixels take less than 10 times the rays to them. Source:
// near_field_sampler.h. Tolerance: measured 9.7. Fails if: each point has as many of its own (16.9).
TEST(NearFieldPlaces, AreShared) {
  const double few = place_rays(64), many = place_rays(256);
  EXPECT_GT(few, 1000);
  EXPECT_LT(many, 10 * few);
  RecordProperty("growth", std::to_string(many / few));
}

}  // namespace
}  // namespace opaline::test
