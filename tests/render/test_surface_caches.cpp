// SPDX-License-Identifier: GPL-3.0-or-later
// When the exitance is evaluated all over a surface instead of at the points of the picture.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/atomic_file.h"
#include "methods/hierarchical/hierarchical_state.h"
#include "methods/hierarchical/surface_caches.h"
#include "opaline/compare.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

Scene torus_scene(int side, int samples_per_pixel) {
  Scene scene = single_shape(TorusShape{{}, 20, 8}, marble(), 8000);
  scene.lights = {point_light({30, 60, 40}, {9000, 8000, 7000})};
  scene.camera.position = {0, 50, 90};
  scene.film.resolution = {side, side};
  scene.film.samples_per_pixel = samples_per_pixel;
  return scene;
}

bool has_cache(const Scene& scene) {
  return hierarchical_state(Prepared(scene).bodies[0]).uses_surface_cache;
}

// Claim: left to itself a picture of many points has a surface cache and one of few has none, by pixels and
// by samples a pixel; other evaluators have none, `surface_cache` always. A crop decides as the whole
// picture. Source: evaluator `automatic` in scenes/README.md. Fails if: samples a pixel or the crop's size
// are looked at wrongly.
TEST(SurfaceCaches, WhereManyPointsAskForThem) {
  EXPECT_FALSE(has_cache(torus_scene(64, 1)));
  EXPECT_TRUE(has_cache(torus_scene(2500, 1)));
  EXPECT_TRUE(has_cache(torus_scene(625, 16)));
  Scene scene = torus_scene(2500, 1);
  scene.film.crop = {{0, 0, 8, 8}};
  EXPECT_TRUE(has_cache(scene));
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  EXPECT_FALSE(has_cache(scene));
  scene = torus_scene(16, 1);
  scene.settings.evaluator = EvaluatorKind::surface_cache;
  EXPECT_TRUE(has_cache(scene));
}

// Claim: a long thin bar of few samples, whose sides would be cut into a hundred thousand squares of the near
// field's size, is evaluated at the points of the picture though a surface cache is asked for, and the plan's
// memory says what such a cache is expected to take. Source: most_wanted_places. Measured without the bound: 204
// MB where 11 were foreseen. Fails if: most_cache_places lets a wanted cache have any number of places.
TEST(SurfaceCaches, NeedlesFallBackToPoints) {
  Scene scene = single_shape(SlabShape{{}, 30, 32000, 1}, marble(), 500);
  scene.lights = {point_light({30, 60, 40}, {9000, 8000, 7000})};
  scene.camera.position = {0, 50, 90};
  scene.film.resolution = {16, 16};
  scene.settings.evaluator = EvaluatorKind::surface_cache;
  EXPECT_FALSE(has_cache(scene));
  const std::size_t bytes = Prepared(scene).plan.bytes;
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  EXPECT_GT(bytes, Prepared(scene).plan.bytes + 500 * kBytesOfPlace);
}

/// Of the pixels' errors, in the worst channel, through a surface cache that is asked for, against the exact sum.
double p99_of_cache(Scene scene) {
  scene.settings.evaluator = EvaluatorKind::surface_cache;
  const Image interpolated = Prepared(scene).picture();
  scene.settings.evaluator = EvaluatorKind::brute_force;
  const Image exact = Prepared(scene).picture();
  const RelativeErrors errors = relative_errors(extract_layer(interpolated, "diffuse"),
                                                extract_layer(exact, "diffuse"), object_pixels(exact));
  double worst = 0;
  for (const std::vector<double>& channel : errors.channels)
    worst = std::max(worst, error_statistics(channel).p99);
  testing::Test::RecordProperty("p99", std::to_string(worst));
  return worst;
}

// Claim: the picture through a surface cache that is asked for is that of the exact sum, beside shadow edges, too, at
// 99 % of the object's pixels. Source: the promise of surface_cache.h. Tolerance: 1.5 times the setting's .5 %
// (measured .65 %: the dipole's bumps over single samples between a torus's vertices). Fails if: the cache's
// own part is left out, or counted twice, or lattices hold shadow edges (2.6 %).
TEST(SurfaceCaches, PictureOfTheExactSum) {
  Scene scene = torus_scene(512, 1);
  scene.film.crop = {{128, 128, 384, 384}};
  EXPECT_LT(p99_of_cache(std::move(scene)), .0075);
}

/// A ball with bumps in two rows of four, of 168 triangles with smooth normals.
MeshFile coarse_bumpy_ball() {
  constexpr int kAround = 12, kRows = 8;
  std::string text;
  for (int row = 0; row <= kRows; ++row)
    for (int i = 0; i < (row % kRows == 0 ? 1 : kAround); ++i) {
      const double theta = std::numbers::pi * row / kRows, phi = 2 * std::numbers::pi * i / kAround;
      const double r = 20 * (1 + .35 * std::sin(4 * phi) * std::sin(2 * theta));
      text += fmt::format("v {} {} {}\n", r * std::sin(theta) * std::cos(phi), r * std::cos(theta),
                          r * std::sin(theta) * std::sin(phi));
    }
  const auto vertex = [](int row, int i) {
    if (row == 0) return 1;
    return row == kRows ? 2 + (kRows - 1) * kAround : 2 + (row - 1) * kAround + i % kAround;
  };
  for (int row = 0; row < kRows; ++row)
    for (int i = 0; i < kAround; ++i) {
      const int a = vertex(row, i), b = vertex(row, i + 1), c = vertex(row + 1, i + 1),
                d = vertex(row + 1, i);
      if (row > 0) text += fmt::format("f {} {} {}\n", a, b, c);
      if (row + 1 < kRows) text += fmt::format("f {} {} {}\n", a, c, d);
    }
  MeshFile file;
  file.path = testing::TempDir() + "coarse_bumpy_ball.obj";
  write_file(file.path, text);
  return file;
}

// Claim: so it is on a coarse mesh that hides much of the even light from itself: between its vertices, too,
// 99 % of the pixels are within the tolerance. Source: surface_cache.h. Tolerance: the promise (measured .41 %).
// Fails if: slopes of vertices tell alone whether long triangles want nodes (3.3 %).
TEST(SurfaceCaches, CoarseMeshInEvenLight) {
  Scene scene = single_shape(coarse_bumpy_ball(), marble(), 8000);
  scene.lights = {{"surroundings", Surroundings{Rgb(1)}}};
  scene.camera.position = {0, 50, 90};
  scene.film.resolution = {160, 160};
  EXPECT_LT(p99_of_cache(std::move(scene)), .005);
}

// Claim: a tighter tolerance gives a finer cache where it holds the shadows' edges, too: a fifth of it at
// least twice the places. Source: kBumps and kEdgeNoise are shares of it. Fails if: they are fixed shares of
// the exitance.
TEST(SurfaceCaches, FollowTheTolerance) {
  Scene scene = torus_scene(2500, 1);
  const auto places = [&](double tolerance) {
    scene.settings.tolerance = tolerance;
    return hierarchical_state(Prepared(scene).bodies[0]).cache()->places();
  };
  const double coarse = double(places(.005)), fine = double(places(.001));
  RecordProperty("coarse", std::to_string(coarse));
  RecordProperty("fine", std::to_string(fine));
  EXPECT_GT(fine, 2 * coarse);
}

// Claim: where the mean free path is not far below the sample spacing and normals are smooth, a picture
// through the surface cache of `automatic` traces camera rays alone; on facets, in a denser medium, and beside
// shadow edges through one that is asked for, shadow rays as well. Source: can_hold_own_light, OwnLight. Fails if:
// caches never hold the own light, or always.
TEST(SurfaceCaches, SpareTheShadowRays) {
  Scene scene = torus_scene(2500, 1);
  scene.film.crop = {{1216, 1440, 1280, 1504}};
  const auto rays = [](const Scene& of) {
    const Prepared prepared(of);
    const std::uint64_t before = prepared.rays.statistics().rays;
    prepared.picture();
    return prepared.rays.statistics().rays - before;
  };
  EXPECT_EQ(rays(scene), 64u * 64u);
  Scene facets = scene;
  facets.shapes[0].normals = NormalMode::faceted;
  EXPECT_GT(rays(facets), 64u * 64u);
  Scene dense = scene;
  dense.media = {grey_medium(.05, .02, 1.3)};
  EXPECT_GT(rays(dense), 64u * 64u);
  scene.settings.evaluator = EvaluatorKind::surface_cache;
  scene.film.crop = {{1280, 1136, 1344, 1200}};
  EXPECT_GT(rays(scene), 64u * 64u);
}

}  // namespace
}  // namespace opaline::test
