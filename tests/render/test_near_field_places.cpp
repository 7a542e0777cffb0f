// SPDX-License-Identifier: GPL-3.0-or-later
// What the places beside shadow edges cost, and the noise that they leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/shade.h"
#include "render/tile_renderer.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

/// Rays of the picture besides those that one with its points' own irradiance traces.
double place_rays(int side) {
  Scene scene = single_shape(TorusShape{{}, 20, 8}, marble(), 8000);
  scene.lights = {point_light({30, 60, 40}, {9000, 8000, 7000})};
  scene.camera.position = {0, 50, 90};
  scene.film.resolution = {side, side};
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  const auto rays_of = [&](NearIrradiance near) {
    scene.settings.near_irradiance = near;
    const Prepared prepared(scene);
    const std::uint64_t before = prepared.rays.statistics().rays;
    prepared.picture();
    return double(prepared.rays.statistics().rays - before);
  };
  return rays_of(NearIrradiance::mixed) - rays_of(NearIrradiance::point);
}

/// The largest relative difference of the diffuse light, of green, between two pictures and their mean that
/// differ by their random numbers alone: a point light has none but those of the places.
double largest_noise() {
  Scene scene = single_shape(TorusShape{{}, 20, 8}, marble(), 8000);
  scene.media[0].profile = ProfileKind::normalized_diffusion;
  scene.lights = {point_light({30, 60, 40}, {9000, 8000, 7000})};
  scene.camera.position = {0, 50, 90};
  scene.film.resolution = {192, 192};
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  const Prepared prepared(scene);
  const RenderInput input{prepared.scene, prepared.world, prepared.rays, prepared.pre.groups};
  const Shader shader(input);
  const TileRenderer renderer(input, shader);
  double largest = 0;
  for (const Rectangle& tile : tiles_of(scene.film)) {
    const TileRenderer::Tile a = renderer.render(tile, {1, 0}), b = renderer.render(tile, {2, 0});
    for (std::size_t i = 0; i < a.sums.size(); ++i) {
      const double one = double(a.sums[i].diffuse.y), other = double(b.sums[i].diffuse.y);
      if (one + other > 0) largest = std::max(largest, std::abs(one - other) / (one + other));
    }
  }
  return largest;
}

// Claim: where most is at stake, beside the edges of deep shadows, there are most places: no pixel is far
// off. Source: near_field_sampler.h. Tolerance: measured 5.1 %. Fails if: the stakes are not looked at (9.8
// %), or another pass draws the same places (0).
TEST(NearFieldPlaces, AreMoreWhereMoreIsAtStake) {
  const double noise = largest_noise();
  EXPECT_LT(noise, .07);
  EXPECT_GT(noise, .01);
}

// Claim: neighbours share their places: 16 times the pixels take less than 10 times the rays to them. Source:
// near_field_sampler.h. Tolerance: measured 8.0. Fails if: each point has as many of its own (16.9).
TEST(NearFieldPlaces, AreShared) {
  const double few = place_rays(64), many = place_rays(256);
  EXPECT_GT(few, 1000);
  EXPECT_LT(many, 10 * few);
  RecordProperty("growth", std::to_string(many / few));
}

}  // namespace
}  // namespace opaline::test
