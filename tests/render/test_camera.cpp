// SPDX-License-Identifier: GPL-3.0-or-later
// Projections, shift and depth of field.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "render/camera_rays.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

constexpr double kUnit = 2.5;  // mm of the world's unit

Film film_of(int rays) {
  Film film;
  film.resolution = {64, 48};
  film.samples_per_pixel = rays;
  return film;
}

World far_world() {
  World world;
  world.origin = {100, -20, 7};
  world.unit = kUnit;
  return world;
}

Camera looking_down() {
  Camera camera;
  camera.position = {110, 30, 40};
  camera.look_at = {90, 5, -10};
  return camera;
}

Camera parallel() {
  Camera camera = looking_down();
  camera.orthographic_height = 36;
  return camera;
}

Camera with_lens(double aperture, double focus, int blades = 0) {
  Camera camera = looking_down();
  camera.aperture = aperture;
  camera.focus_distance = focus;
  camera.blades = blades;
  return camera;
}

Vec3d point_at(const Ray& ray, double depth) {
  return Vec3d(ray.origin) + Vec3d(ray.direction) * depth;
}

// Claim: a point of a pixel's middle ray is projected to the middle of this pixel at its depth, in every projection.
// Source: the definition of film_place. Tolerance: single precision of rays, 1e-3 pixels. Fails if: the shift moves rays and
// projection apart, or the lens displaces the middle.
TEST(Camera, ProjectsItsRaysToTheirPixels) {
  Camera shifted = looking_down(), lens = with_lens(9, 50);
  shifted.shift = {.3, -.2};
  for (const Camera& camera : {looking_down(), parallel(), shifted, lens}) {
    const CameraRays rays(camera, film_of(4), far_world());
    for (const auto& [x, y] : {std::pair{0, 0}, std::pair{63, 12}, std::pair{31, 47}}) {
      const CameraRays::FilmPlace seen = rays.film_place(point_at(rays.middle_ray(x, y), 17));
      EXPECT_NEAR(seen.x, x + .5, 1e-3);
      EXPECT_NEAR(seen.y, y + .5, 1e-3);
      EXPECT_NEAR(seen.depth, 17, 1e-4);
    }
  }
}

// Claim: rays of a parallel projection have the view's direction, one pixel of height / rows apart, and pass beside the
// camera's position as many mm as their pixels say. Source: scenes/README.md. Tolerance: single precision. Fails if: the
// height is halved, or taken in the world's units.
TEST(Camera, ParallelRaysAreAsFarApartAsPixels) {
  const Camera camera = parallel();
  const CameraRays rays(camera, film_of(1), far_world());
  const Vec3d forward = normalized(camera.look_at - camera.position);
  const double pixel = 36 / kUnit / 48;
  for (const int y : {0, 20, 47}) {
    const Ray ray = rays.ray(11, y, 0);
    EXPECT_NEAR(length(Vec3d(ray.direction) - forward), 0, 1e-6);
    EXPECT_NEAR(length(Vec3d(rays.ray(12, y, 0).origin) - Vec3d(ray.origin)), pixel, 1e-5);
    const Vec3d beside = Vec3d(ray.origin) - into_world(far_world(), camera.position);
    EXPECT_NEAR(length(beside), pixel * std::hypot(11.5 - 32, y + .5 - 24), 1e-5);
  }
  EXPECT_NEAR(pixel_width(camera, film_of(1), far_world()).at(1234), pixel, 1e-12);
}

// Claim: a pixel twice as wide as high has rays twice as far apart along rows and as far as before along columns, around the
// same middle, in both projections; its points are projected to it, and the aspect 1 changes nothing. Source: OpenEXR's
// pixelAspectRatio, width over height. Tolerance: single precision. Fails if: the aspect is inverted, scales heights, or the
// projection lacks it.
TEST(Camera, PixelsHaveAnAspect) {
  for (const Camera& camera : {looking_down(), parallel()}) {
    Film wide = film_of(4);
    wide.pixel_aspect = 2;
    const CameraRays plain(camera, film_of(4), far_world()), rays(camera, wide, far_world());
    const auto step = [](const CameraRays& of, int x, int y) {
      const Vec3d here = point_at(of.middle_ray(20, 30), 17);
      return point_at(of.middle_ray(20 + x, 30 + y), 17) - here;
    };
    EXPECT_NEAR(length(step(rays, 1, 0) - 2. * step(plain, 1, 0)), 0, 2e-5);
    EXPECT_NEAR(length(step(rays, 0, 1) - step(plain, 0, 1)), 0, 2e-5);
    const CameraRays::FilmPlace seen = rays.film_place(point_at(rays.middle_ray(3, 40), 17));
    EXPECT_NEAR(seen.x, 3.5, 1e-3);
    EXPECT_NEAR(seen.y, 40.5, 1e-3);
    const CameraRays::FilmPlace middle = rays.film_place(into_world(far_world(), camera.look_at));
    EXPECT_NEAR(middle.x, 32, 1e-3);
    EXPECT_NEAR(middle.y, 24, 1e-3);
  }
}

// Claim: a shift by a fraction of the image is the view of as many pixels further to the right and up. Source: scenes/README.md.
// Tolerance: single precision. Fails if: it is counted in heights both ways, or down.
TEST(Camera, ShiftMovesByPixels) {
  Camera camera = looking_down();
  const CameraRays plain(camera, film_of(1), far_world());
  camera.shift = {.25, .125};
  const CameraRays shifted(camera, film_of(1), far_world());
  const Vec3f there = shifted.ray(10, 20, 0).direction, here = plain.ray(10 + 16, 20 - 6, 0).direction;
  EXPECT_NEAR(length(there - here), 0, 1e-6f);
}

// Part of the unit square around the origin with x cos + y sin below a distance.
double covered(double cosine, double sine, double distance) {
  const double a = std::abs(cosine), b = std::abs(sine);
  const auto half_square = [](double side) { return side > 0 ? side * side / 2 : 0; };
  return (half_square(distance + (a + b) / 2) - half_square(distance + (a - b) / 2) -
          half_square(distance - (a - b) / 2) + half_square(distance - (a + b) / 2)) /
         (a * b);
}

// Claim: the samples of a pixel have its centre as mean, and resolve edges almost as a regular grid does. Source: exact areas, for
// random edges; the error of a grid, or a value between those of two grids. Tolerance: 15 %. Fails if: samples are a part of
// a long sequence (R2: .152, .089, .070, .021 at 4, 9, 16, 64, and the mean .03 to .19 pixels off).
TEST(Camera, SamplesOfAPixelResolveEdges) {
  for (const auto& [count, grid] :
       {std::pair{4, .0885}, {9, .0480}, {16, .0314}, {64, .0111}, {10, .055}, {7, .07}}) {
    const CameraRays rays(looking_down(), film_of(count), far_world());
    std::vector<Vec3d> places;
    Vec3d mean;
    for (int s = 0; s < count; ++s) {
      const CameraRays::FilmPlace seen = rays.film_place(point_at(rays.ray(20, 30, s), 17));
      places.push_back({seen.x - 20.5, seen.y - 30.5, 0});
      mean = mean + places.back() * (1. / count);
    }
    EXPECT_LT(length(mean), 2e-3) << count;
    double squares = 0;
    constexpr int kEdges = 20000;
    for (std::uint64_t i = 0; i < kEdges; ++i) {
      const auto [turn, place] = r2_point(i, {.1, .2});
      const double cosine = std::cos(2 * kPi * turn), sine = std::sin(2 * kPi * turn),
                   distance = (place - .5) * (std::abs(cosine) + std::abs(sine));
      const auto below =
          std::ranges::count_if(places, [&](const Vec3d& p) { return p.x * cosine + p.y * sine < distance; });
      const double error = double(below) / count - covered(cosine, sine, distance);
      squares += error * error / kEdges;
    }
    EXPECT_LT(std::sqrt(squares), 1.15 * grid) << count;
  }
}

// Claim: all rays of a pixel meet in the plane of focus, where the pinhole's ray with this sub-pixel position does. Source:
// the thin lens. Tolerance: single precision at a distance of 20. Fails if: the focus is measured along rays, or in mm.
TEST(Camera, RaysMeetInThePlaneOfFocus) {
  for (const double focus : {12., 50., 400.}) {
    const CameraRays pinhole(looking_down(), film_of(16), far_world()),
        lens(with_lens(9, focus), film_of(16), far_world());
    for (int s = 0; s < 16; ++s)
      EXPECT_NEAR(length(point_at(lens.ray(5, 40, s), focus / kUnit) -
                         point_at(pinhole.ray(5, 40, s), focus / kUnit)),
                  0, 2e-5 * focus);
  }
}

// Claim: elsewhere they spread over the disc of the thin lens: at depth z its radius is (aperture / 2) |1 - z / focus|, uniformly
// filled: the mean square distance is half of its square, and no ray is farther. Source: geometry; blur_radius says the same in
// pixels. Tolerance: .5 % of the mean square with 4,096 rays. Fails if: the lens is sampled towards its middle, or has the radius of
// its diameter.
TEST(Camera, BlurIsADiscOfTheLens) {
  const Camera camera = with_lens(9, 50);
  const Film film = film_of(4096);
  const CameraRays rays(camera, film, far_world()), pinhole(looking_down(), film, far_world());
  for (const double depth : {6., 35., 90.}) {
    const double radius = 4.5 / kUnit * std::abs(1 - depth * kUnit / 50);
    double squares = 0, most = 0;
    for (int s = 0; s < 4096; ++s) {
      const double apart = length(point_at(rays.ray(9, 9, s), depth) - point_at(pinhole.ray(9, 9, s), depth));
      squares += apart * apart / 4096;
      most = std::max(most, apart);
    }
    EXPECT_NEAR(squares, radius * radius / 2, .005 * radius * radius / 2);
    EXPECT_LT(most, 1.001 * radius);
    EXPECT_GT(most, .98 * radius);
    EXPECT_NEAR(rays.blur_radius(depth), radius / pixel_width(camera, film, far_world()).at(depth), 1e-9);
  }
}

// Claim: an iris of n blades is the regular polygon in the lens: its mean square radius is (2 + cos(2 pi / n)) / 6, its corners reach
// the circle, and many blades are round. Source: second moment of a regular polygon. Tolerance: 1 % with 4,096 rays. Fails if: blades
// are corners on another circle, or triangles are not filled evenly.
TEST(Camera, BladesFormAPolygon) {
  const Film film = film_of(4096);
  const CameraRays pinhole(looking_down(), film, far_world());
  for (const int blades : {3, 4, 6, 100}) {
    const CameraRays rays(with_lens(2 * kUnit, 50, blades), film, far_world());
    double squares = 0, most = 0;
    for (int s = 0; s < 4096; ++s) {
      const double radius = length(Vec3d(rays.ray(3, 3, s).origin) - Vec3d(pinhole.ray(3, 3, s).origin));
      squares += radius * radius / 4096;
      most = std::max(most, radius);
    }
    const double exact = (2 + std::cos(2 * std::numbers::pi / blades)) / 6;
    EXPECT_NEAR(squares, exact, .01 * exact) << blades;
    EXPECT_LT(most, 1.00001);
    EXPECT_GT(most, .98);
  }
}

// Claim: the first rays of different pixels pass different points of the lens: with one ray per pixel the image is noisy, not displaced. Tolerance: the mean of
// 3,072 uniform points. Fails if: all pixels share one place.
TEST(Camera, PixelsRotateTheLens) {
  const CameraRays rays(with_lens(2 * kUnit, 50), film_of(1), far_world());
  const Vec3d middle(rays.middle_ray(0, 0).origin);
  Vec3d sum;
  double squares = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      const Vec3d place = Vec3d(rays.ray(x, y, 0).origin) - middle;
      sum += place;
      squares += dot(place, place);
    }
  EXPECT_LT(length(sum) / 3072, .04);
  EXPECT_NEAR(squares / 3072, .5, .02);
}

// Claim: a small far lamp out of focus shows as a disc as large as blur_radius says, with the light that it has in focus.
// Source: energy; the lamp alone is in the image. Tolerance: 3 % of the sum and of the root mean square radius with 400 rays a pixel.
// Fails if: rays through the lens carry another weight than the pinhole's, or lamps are met from the middle of the lens alone.
TEST(Camera, LampsBlurToDiscsOfTheSameLight) {
  Scene scene = single_shape(SphereShape{{0, 0, 900}, 1, kLeastFineness}, grey_medium(1, 0.5, 1.3), 1);
  scene.lights = {Light{"lamp", SphereLight{{0, 0, 0}, .5, Rgb(3)}}};
  scene.camera = Camera{{0, 0, 100}, {0, 0, 0}};
  scene.camera.field_of_view = 20;
  scene.film.resolution = {96, 96};
  scene.film.samples_per_pixel = 400;
  scene.settings.method = Method::lambert;
  const auto measured = [&] {
    const Image image = Prepared(scene).picture();
    double sum = 0, squares = 0;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 96; ++x) {
        const double value =
            double(image.pixels[(std::size_t(y) * 96 + std::size_t(x)) * image.channels.size()]);
        sum += value;
        squares += value * (std::pow(x - 47.5, 2) + std::pow(y - 47.5, 2));
      }
    return std::pair{sum, std::sqrt(2 * squares / sum)};
  };
  const auto [sharp, own_radius] = measured();
  scene.camera.aperture = 8;
  scene.camera.focus_distance = 50;
  const auto [blurred, radius] = measured();
  const World world = make_world(scene);
  const double blur = CameraRays(scene.camera, scene.film, world).blur_radius(100 / world.unit);
  EXPECT_GT(blur, 5 * own_radius);
  EXPECT_NEAR(blurred, sharp, .03 * sharp);
  EXPECT_NEAR(radius, std::hypot(blur, own_radius), .03 * blur);
}

// Claim: a lens of almost no diameter renders the pinhole's image, with bounced light, and so does a parallel projection of the
// height seen at the distance, from far away. Tolerance: 1e-3 of the mean; 2 %. Fails if: footprints or projections of
// parallel rays are those of a pinhole.
TEST(Camera, LimitsAgree) {
  Scene scene = single_shape(SphereShape{{0, 0, 0}, 10, kLeastFineness}, grey_medium(1, 0.5, 1.3), 1);
  Shape floor;
  floor.name = "floor";
  floor.source = QuadShape{{-30, -10, 30}, {60, 0, 0}, {0, 0, -60}};
  scene.shapes.push_back(floor);
  scene.lights = {point_light({20, 60, 50}, Rgb(2e4))};
  scene.camera = Camera{{0, 2000, 2200}, {0, 0, 0}};
  scene.camera.field_of_view = .9;
  scene.film.resolution = {32, 32};
  scene.film.samples_per_pixel = 4;
  const auto mean = [&] {
    const Image image = Prepared(scene).picture();
    double sum = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += image.channels.size())
      sum += double(image.pixels[i]);
    return sum;
  };
  for (const Method method : {Method::hierarchical, Method::volume_diffusion}) {
    scene.settings.method = method;
    scene.camera.aperture = 0;
    scene.camera.orthographic_height.reset();
    const double pinhole = mean();
    EXPECT_GT(pinhole, 0);
    scene.camera.aperture = 1e-6;
    EXPECT_NEAR(mean(), pinhole, 1e-3 * pinhole);
    scene.camera.aperture = 0;
    scene.camera.orthographic_height =
        2 * std::tan(.45 * std::numbers::pi / 180) * length(scene.camera.position);
    EXPECT_NEAR(mean(), pinhole, .02 * pinhole);
  }
}

}  // namespace
}  // namespace opaline::test
