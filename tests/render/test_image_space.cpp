// SPDX-License-Identifier: GPL-3.0-or-later
// The hierarchical sum over points seen from the lights.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/scratch_folder.h"
#include "methods/image_space/light_views.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"
#include "transport/fresnel.h"

namespace opaline::test {
namespace {

Scene lit_ball(std::vector<Light> lights) {
  Scene scene = single_shape(SphereShape{{}, 10}, marble(), 10'000);
  scene.camera.position = {40, 10, 20};
  scene.lights = std::move(lights);
  scene.settings.method = Method::image_space;
  return scene;
}

// Transmitted by the body of a scene, W, in red.
double flux_of(const Scene& scene) {
  const Prepared prepared(scene);
  const Body& body = prepared.bodies[0];
  double flux = 0;
  for (const FluxSample& sample :
       seen_from_lights({prepared.scene, prepared.world, prepared.rays, prepared.plan}, body,
                        body.plan.spacing / prepared.world.unit))
    flux += double(sample.area) * double(sample.irradiance.x);
  return flux * prepared.world.unit * prepared.world.unit;
}

std::vector<double> reds(const Image& image) {
  const auto red = std::size_t(std::ranges::find(image.channels, "diffuse.R") - image.channels.begin());
  std::vector<double> values;
  for (std::size_t at = red; at < image.pixels.size(); at += image.channels.size())
    values.push_back(double(image.pixels[at]));
  return values;
}

// Mean difference over the mean of the other.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0, off = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += b[i], off += std::abs(a[i] - b[i]);
  return off / sum;
}

std::vector<double> reds_by(Scene scene, Method method) {
  scene.settings.method = method;
  return reds(cold_picture(scene));
}

// Claim: the flux of all points is that transmitted into a ball: parallel light, E pi R^2 (1 - F_bar); even light all
// around, L pi 4 pi R^2 (1 - F_bar); a point at its centre's distance d, less. Source: integrals over the sphere. Tolerance:
// 1 %, of the pixels at the outline; 2 % for the directions of an environment. Fails if: a pixel's area lacks 1 / cosine or the distance.
TEST(ImageSpace, FluxIntoABall) {
  const double transmitted = kPi * 100 * (1 - average_reflectance_outside(1.5));
  EXPECT_NEAR(flux_of(lit_ball({{"sun", DirectionalLight{{0, -1, 0}, Rgb(2)}}})) / (2 * transmitted), 1, .01);
  EXPECT_NEAR(flux_of(lit_ball({{"sky", Surroundings{Rgb(1)}}})) / (4 * kPi * transmitted), 1, .02);
  // Beyond many radii, a point light is parallel.
  EXPECT_NEAR(flux_of(lit_ball({point_light({0, 0, 1e4}, Rgb(1e8))})) / transmitted, 1, .01);
  double near = 0;  // exact, by the cosine at the ball's centre
  const double distance = 14;
  constexpr int kRings = 20'000;
  for (int i = 0; i < kRings; ++i) {
    const double mu = (i + .5) / kRings, d2 = 100 + distance * distance - 20 * distance * mu;
    const double cosine = (distance * mu - 10) / std::sqrt(d2);
    if (cosine > 0) near += 2 * kPi * 100 / kRings * cosine / d2 * fresnel_transmittance(cosine, 1.5);
  }
  EXPECT_NEAR(flux_of(lit_ball({point_light({0, 0, distance}, Rgb(1))})) / near, 1, .01);
}

// Claim: the image is that of `hierarchical`, in the light of points, suns, spots and areas, beside a shadow and with two
// lights. Source: the same sum over other points. Tolerance: 3 % in the mean. Fails if: samples of one light count for another, or
// pixels are weighted as equal areas.
TEST(ImageSpace, IsTheHierarchicalSum) {
  const Light sun{"sun", DirectionalLight{normalized(Vec3d{-1, -1, -.3}), Rgb(3)}};
  const Light area{"area", QuadLight{{15, 20, 0}, {8, 0, 0}, {0, 0, 8}, Rgb(5)}};
  for (const std::vector<Light>& lights :
       {std::vector<Light>{point_light({20, 20, 20}, Rgb(1000))},
        {sun},
        {{"spot", SpotLight{{30, 20, 10}, normalized(Vec3d{-3, -2, -1}), Rgb(3000), 30, 10}}},
        {area},
        {sun, point_light({0, 0, 14}, Rgb(200))}}) {
    Scene scene = lit_ball(lights);
    Shape blocker;
    blocker.name = "blocker";
    blocker.source = SphereShape{{14, 14, 6}, 3};
    scene.shapes.push_back(blocker);
    EXPECT_LT(difference(reds_by(scene, Method::image_space), reds_by(scene, Method::hierarchical)), .03)
        << lights[0].name;
  }
}

// The same without a mean: largest difference over the largest value of the other.
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most / std::ranges::max(b);
}

// Claim: terminators have no bites, as by `hierarchical`. Source: the same sum over other points. Tolerance: 3 % of the
// brightest pixel. Fails if: the pixels of a light's view are as wide at grazing angles as across the light.
TEST(ImageSpace, SmoothTerminators) {
  Scene scene = lit_ball({point_light({30, 40, 40}, Rgb(6000))});
  scene.settings.samples = 3000;
  scene.media = {grey_medium(.3, .1, 1.4)};
  scene.film.resolution = {128, 128};
  EXPECT_LT(largest_difference(reds_by(scene, Method::image_space), reds_by(scene, Method::hierarchical)),
            .03);
}

// Claim: light enters by the normals of maps as by `hierarchical` with many samples. Source: the same sum, converged. Tolerance:
// 8 % in the mean. Fails if: the near field has the irradiance of the pixel's own normal.
TEST(ImageSpace, NormalMaps) {
  const ScratchFolder folder;
  put_exr(folder.file("tilts.exr"), 512, 256, [](int x, int y) {
    const std::uint64_t bits = hash_bits(std::uint64_t(x), std::uint64_t(y));
    const double tilt = .8 * unit_double(bits), side = 2 * kPi * unit_double(hash_bits(bits, 1));
    return std::array{.5 + .5 * std::sin(tilt) * std::cos(side), .5 + .5 * std::sin(tilt) * std::sin(side),
                      .5 + .5 * std::cos(tilt)};
  });
  const auto reds_of = [&](const std::string& method, int samples) {
    return reds(picture_of(folder, fmt::format(R"({{"media": {{"m": {{"sigma_a": 0.1, "sigma_s_prime": 2}}}},
      "shapes": [{{"sphere": {{"radius": 20}}, "medium": "m", "normal_map": {{"texture": "tilts.exr"}}}}],
      "lights": [{{"type": "point", "position": [60, 60, 60], "intensity": 20000}}],
      "camera": {{"position": [0, 0, 100], "field_of_view": 30}},
      "film": {{"resolution": [160, 160], "pixel_type": "float"}},
      "settings": {{"method": "{}", "samples": {}}}}})",
                                               method, samples)));
  };
  EXPECT_LT(difference(reds_of("image_space", 6000), reds_of("hierarchical", 200'000)), .08);
}

// Claim: a light inside the box of a body is seen all around it. Source: the flux of rays in all directions, as by
// `hierarchical`. Tolerance: 3 %. Fails if: one plane before the light is its view.
TEST(ImageSpace, LightInTheMiddleOfARing) {
  Scene scene = single_shape(TorusShape{{}, 10, 3}, marble(), 10'000);
  scene.camera.position = {0, 40, 30};
  scene.lights = {point_light({0, 0, 0}, Rgb(100))};
  EXPECT_LT(difference(reds_by(scene, Method::image_space), reds_by(scene, Method::hierarchical)), .03);
}

// Claim: even light leaves white balls even, and as by diffuse reflection. Source: energy; the profile's share within
// the ball is missing. Tolerance: the largest difference 4 %. Fails if: directions of an environment are not weighted to one sphere.
TEST(ImageSpace, Furnace) {
  Scene scene = lit_ball({{"sky", Surroundings{Rgb(1)}}});
  scene.media = {grey_medium(.3, 0, 1.3)};
  scene.settings.light_samples = 256;
  EXPECT_LT(difference(reds_by(scene, Method::image_space), reds_by(scene, Method::hierarchical)), .03);
}

// Claim: the pixels of a box that grows a little contain those of before, so points stay in slow motion. Source: a fixed
// lattice. Fails if: the lattice begins at the box, its pixels share the box, or the middle ray follows the box's centre.
TEST(ImageSpace, PixelsStayInSlowMotion) {
  const Bounds before{{-5, -6, -7}, {5, 6, 7}}, after{{-5, -6, -7}, {5.3, 6.2, 7}};
  const Vec3d towards = normalized(Vec3d{1, 2, .5});
  const auto are_within = [](const LightView& some, const LightView& all) {
    const auto same = [](const Ray& a, const Ray& b) {
      const Vec3f moved = a.origin - b.origin;  // along the ray
      return length(a.direction - b.direction) < 1e-5f && length(cross(moved, a.direction)) < 1e-3f;
    };
    return std::ranges::all_of(some.rays, [&](const Ray& ray) {
      return std::ranges::any_of(all.rays, [&](const Ray& other) { return same(ray, other); });
    });
  };
  const LightView small = parallel_view(before, towards, 20, .9);
  EXPECT_GT(small.rays.size(), 100u);
  EXPECT_TRUE(are_within(small, parallel_view(after, towards, 20.4, .95)));
  EXPECT_TRUE(are_within(view_from(before, {30, 3, 0}, .9), view_from(after, {30, 3, 0}, .9)));
}

// Claim: a moved camera keeps the views; another light, medium or mesh does not. Source: the key of the stage. Fails if:
// the key leaves one of them out.
TEST(ImageSpace, CameraKeepsTheViews) {
  Session session;
  Scene scene = lit_ball({{"sun", DirectionalLight{{0, -1, 0}, Rgb(2)}}});
  const auto decision_of = [&] {
    session.edit(scene);
    session.prepare();
    return session.decisions().back();
  };
  EXPECT_EQ(decision_of(), "shape: views from the lights traced");
  scene.camera.position = {0, 0, 50};
  EXPECT_EQ(decision_of(), "shape: views from the lights reused");
  std::get<DirectionalLight>(scene.lights[0].source).irradiance = Rgb(1);
  EXPECT_EQ(decision_of(), "shape: views from the lights traced");
  scene.media[0].eta = 1.3;
  EXPECT_EQ(decision_of(), "shape: views from the lights traced");
  scene.shapes[0].source = SphereShape{{}, 11};
  EXPECT_EQ(decision_of(), "shape: views from the lights traced");
}

// Claim: without light on the body, the image is black and finite: lights that point away, or inside of it. Source:
// energy. Fails if: an empty tree is evaluated, or the inner side of the surface is lit.
TEST(ImageSpace, NoLightArrives) {
  for (const Light& light :
       {Light{"spot", SpotLight{{30, 0, 0}, {1, 0, 0}, Rgb(100), 30, 10}}, point_light({0, 0, 0}, Rgb(100))})
    for (const double red : reds_by(lit_ball({light}), Method::image_space)) ASSERT_EQ(red, 0) << light.name;
}

}  // namespace
}  // namespace opaline::test
