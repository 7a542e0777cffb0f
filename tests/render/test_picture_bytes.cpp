// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>

#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

// A scene with all kinds of light and both kinds of surface.
Scene mixed_scene() {
  Scene scene = single_shape(TorusShape{{}, 20, 8}, marble(), 8000);
  Shape floor;
  floor.name = "floor";
  floor.source = QuadShape{{-60, -10, 60}, {120, 0, 0}, {0, 0, -120}};
  floor.reflectance = {.4, .3, .2};
  scene.shapes.push_back(floor);
  scene.lights = {point_light({30, 60, 40}, {9000, 8000, 7000}),
                  {"sphere", SphereLight{{-40, 40, 20}, 8, {3, 4, 5}}},
                  {"quad", QuadLight{{-10, 70, -10}, {20, 0, 0}, {0, 0, 20}, {2, 2, 2}}},
                  {"sun", DirectionalLight{normalized(Vec3d{-1, -2, -1}), {.5, .5, .4}}},
                  {"all around", Surroundings{{.2, .3, .4}}}};
  scene.camera.position = {0, 50, 90};
  scene.film.resolution = {48, 40};
  scene.film.samples_per_pixel = 2;
  scene.settings.light_samples = 16;
  return scene;
}

Image picture_by_threads(const Scene& scene, int threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  return Prepared(scene).picture();
}

// Claim: the picture's bytes depend on the scene alone. Source: bits do not move. Tolerance none.
// Fails when: a sum is taken in the order in which threads finish (try unordered accumulation in
// surface_shares).
TEST(PictureBytes, SameForOneAndTwoThreadsAndTwoRuns) {
  const Image one = picture_by_threads(mixed_scene(), 1);
  EXPECT_TRUE(same_pixels(one, picture_by_threads(mixed_scene(), 2)));
  EXPECT_TRUE(same_pixels(one, picture_by_threads(mixed_scene(), 2)));
}

// Claim: another seed moves samples and light samples: bytes differ. Fails when: the seed is ignored.
TEST(PictureBytes, SeedMatters) {
  Scene other = mixed_scene();
  other.settings.seed = 1;
  EXPECT_FALSE(same_pixels(picture_by_threads(mixed_scene(), 2), picture_by_threads(other, 2)));
}

// Claim: a crop's pixels are those of the whole picture. Tolerance none. Fails when: tiles start at the
// crop's corner and light samples are keyed by place in the tile.
TEST(PictureBytes, CropIsPartOfTheWhole) {
  Scene cropped = mixed_scene();
  cropped.film.crop = {{5, 3, 37, 29}};
  const Image whole = picture_by_threads(mixed_scene(), 2), part = picture_by_threads(cropped, 2);
  ASSERT_EQ(part.width, 32);
  ASSERT_EQ(part.height, 26);
  const std::size_t n = whole.channels.size();
  for (int y = 0; y < part.height; ++y) {
    const float* a = whole.pixels.data() + (std::size_t(y + 3) * 48 + 5) * n;
    const float* b = part.pixels.data() + std::size_t(y) * 32 * n;
    EXPECT_EQ(std::memcmp(a, b, 32 * n * sizeof(float)), 0) << "row " << y;
  }
}

// All lengths times k, coefficients over k, intensities times k^2: the same radiance.
Scene enlarged(Scene scene, double k) {
  auto& medium = std::get<PhysicalMedium>(scene.media[0].coefficients);
  medium.sigma_a = medium.sigma_a / k;
  medium.sigma_s_prime = medium.sigma_s_prime / k;
  for (Shape& shape : scene.shapes) {
    Transform& t = shape.to_world;
    t = {t.x * k, t.y * k, t.z * k, t.translation * k};
  }
  for (Light& light : scene.lights) {
    if (auto* point = std::get_if<PointLight>(&light.source)) {
      point->position *= k;
      point->intensity *= k * k;
    } else if (auto* sphere = std::get_if<SphereLight>(&light.source)) {
      sphere->center *= k;
      sphere->radius *= k;
    } else if (auto* quad = std::get_if<QuadLight>(&light.source)) {
      quad->corner *= k;
      quad->u *= k;
      quad->v *= k;
    }
  }
  scene.camera.position *= k;
  scene.camera.look_at *= k;
  return scene;
}

double relative_difference(const Image& a, const Image& b) {
  double difference = 0, sum = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      for (const char* name : {"R", "G", "B"}) {
        difference += std::abs(channel(a, x, y, name) - channel(b, x, y, name));
        sum += channel(a, x, y, name);
      }
  return difference / sum;
}

// Claim: a change of units changes nothing: by a power of two no bit, by another factor no more than the
// other samples' noise. Source: the extremes that must hold: same bytes; other k within 1 %. Fails when: any
// absolute epsilon (a ray offset, a table's range) is in mm.
TEST(PictureBytes, ScaleDoesNotMatter) {
  const Image one = picture_by_threads(mixed_scene(), 2);
  for (const double k : {0.0009765625, 8.0, 4096.0}) {
    const Image other = picture_by_threads(enlarged(mixed_scene(), k), 2);
    std::size_t different = 0;
    for (int y = 0; y < one.height; ++y)
      for (int x = 0; x < one.width; ++x)
        for (const char* name : {"R", "G", "B", "diffuse.R", "specular.G", "irradiance.B", "A", "N.X"})
          different += channel(one, x, y, name) != channel(other, x, y, name) ? 1 : 0;
    EXPECT_EQ(different, 0u) << "k " << k;
  }
  EXPECT_LT(relative_difference(one, picture_by_threads(enlarged(mixed_scene(), 3.7), 2)), 0.01);
}

// Claim: a scene 1e6 mm from the origin gives the same picture within .1 %. Source: the extremes that must
// hold. What is left is the rounding of the mesh's doubles. Fails when: World keeps its origin at zero.
TEST(PictureBytes, FarFromTheOrigin) {
  Scene far = mixed_scene();
  const Vec3d away{1e6, -1e6, 1e6};
  for (Shape& shape : far.shapes) shape.to_world.translation += away;
  std::get<PointLight>(far.lights[0].source).position += away;
  std::get<SphereLight>(far.lights[1].source).center += away;
  std::get<QuadLight>(far.lights[2].source).corner += away;
  far.camera.position += away;
  far.camera.look_at += away;
  EXPECT_LT(relative_difference(picture_by_threads(mixed_scene(), 2), picture_by_threads(far, 2)), 0.001);
}

}  // namespace
}  // namespace opaline::test
