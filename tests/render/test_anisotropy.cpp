// SPDX-License-Identifier: GPL-3.0-or-later
// Boundaries that mirror differently along and across a tangent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/scratch_folder.h"
#include "input/load_scene.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"
#include "transport/rough_boundary.h"

namespace opaline::test {
namespace {

constexpr double kRoughness = .5, kAnisotropy = .7, kDegrees = 35;

// One pixel that sees the origin from (0, 60, 60), where a black surface that faces upwards has a grain; a point's light.
Scene one_highlight(ShapeSource source) {
  Scene scene;
  Shape shape;
  shape.name = "plate";
  shape.source = std::move(source);
  shape.reflectance = Rgb(0.0);
  shape.gloss = Gloss{.roughness = kRoughness, .grain = {kAnisotropy, kDegrees}};
  scene.shapes = {shape};
  const Vec3d at{30, 40, -20};
  scene.lights = {point_light(at, Rgb(dot(at, at)))};
  scene.camera.position = {0, 60, 60};
  scene.camera.look_at = {};
  scene.camera.field_of_view = .01;
  scene.film.resolution = {1, 1};
  scene.film.half = false;
  return scene;
}

// With the direction of u, of a surface that faces +y.
double highlight(const Vec3d& u, const FacetAlphas& facets, double degrees = kDegrees) {
  const double angle = degrees * kPi / 180;
  const Vec3d normal{0, 1, 0}, x = u * std::cos(angle) + cross(normal, u) * std::sin(angle),
                               y = cross(normal, x);
  const auto local = [&](const Vec3d& d) {
    const Vec3d n = normalized(d);
    return Vec3f(Vec3d{dot(n, x), dot(n, y), dot(n, normal)});
  };
  const RoughBoundary boundary(facets, 1.5, 0);
  return double(boundary.value(local({0, 60, 60}), local({30, 40, -20})));
}

double highlight(const Vec3d& u, double anisotropy = kAnisotropy) {
  return highlight(u, facet_alphas(float(kRoughness), float(anisotropy)));
}

double seen(const Scene& scene) {
  return double(channel(cold_picture(scene), 0, 0, "specular.G"));
}

// Claim: a point's highlight is the lobe's value in the frame of u and v, turned counterclockwise by the rotation; u is that
// of a quad's first side, and level where a mesh has no UVs. Source: the reflectance function. Tolerance 1e-3; the next
// frame's value is more than 5 % away. Fails if: the rotation turns the other way, u is taken for v, or the frame is any
// around the normal.
TEST(Anisotropy, HighlightsLieInTheFrameOfTheUvs) {
  const Vec3d x{1, 0, 0}, z{0, 0, 1};
  EXPECT_GT(std::abs(highlight(x) / highlight(z) - 1), .05);
  EXPECT_GT(std::abs(highlight(x) / highlight(x, 0) - 1), .05);
  EXPECT_NEAR(seen(one_highlight(QuadShape{{-50, 0, 50}, {100, 0, 0}, {0, 0, -100}})) / highlight(x), 1,
              1e-3);
  EXPECT_NEAR(seen(one_highlight(QuadShape{{-50, 0, -50}, {0, 0, 100}, {100, 0, 0}})) / highlight(z), 1,
              1e-3);
  // A mesh without UVs, tilted a little about x so that a level direction is known.
  const ScratchFolder folder;
  put_bytes(folder.file("plain.obj"),
            "v -50 -0.01 50\nv 50 -0.01 50\nv 50 0.01 -50\nv -50 0.01 -50\nf 1 2 3\nf 1 3 4\n");
  EXPECT_NEAR(seen(one_highlight(MeshFile{folder.file("plain.obj"), false, {}})) / highlight(x), 1, 2e-3);
}

// Claim: white things whose facets differ along and across are white in a white room, seen from any side: a coat over
// white, a metal, a body, and each of them where roughness is a texture. Source: conservation. Tolerance: .5 % of the mean;
// 2.5 % of each block of 4 x 4 pixels, of which noise has most. Fails if: what a coat takes away is that of another side
// (3 % of a block), or facets of metals reflect once (5 % of the mean).
TEST(Anisotropy, WhiteFurnace) {
  const ScratchFolder folder;
  put_png(folder.file("rough.png"), 64, 64, [](int x, int) {
    return x < 32 ? Bytes{128, 128, 128} : Bytes{160, 160, 160};
  });
  const std::string texture = R"({"texture": ")" + folder.file("rough.png") + R"(", "channel": "g"})";
  for (const char* const surface :
       {R"("reflectance": 1, )", R"("reflectance": 1, "metalness": 1, )", R"("medium": "white")"})
    for (const std::string& roughness : {std::string("0.5"), texture}) {
      SCOPED_TRACE(surface + roughness);
      const std::string coat =
          R"("specular_anisotropy": 0.8, "specular_rotation": 30, "specular_roughness": )" + roughness;
      const bool is_body = surface[1] == 'm';
      const Image image = cold_picture(
          parse_scene(R"({"media": {"white": {"sigma_a": 0, "sigma_s": 1, "specular_ior": 1.5, )" + coat +
                          R"(}}, "shapes": [{"sphere": {"radius": 10}, )" + surface + (is_body ? "" : coat) +
                          R"(}], "surroundings": 1, "settings": {"method": "lambert", "light_samples": 1024},
          "camera": {"position": [0, 0, 100], "field_of_view": 8},
          "film": {"resolution": [32, 32], "samples_per_pixel": 64, "pixel_type": "float"}})",
                      "text.json"));
      double mean = 0;
      for (int y = 0; y < 32; y += 4)
        for (int x = 0; x < 32; x += 4) {
          double block = 0;
          for (int i = 0; i < 16; ++i) block += double(channel(image, x + i % 4, y + i / 4, "G")) / 16;
          EXPECT_NEAR(block, 1, .025) << x << ' ' << y;
          mean += block / 64;
        }
      EXPECT_NEAR(mean, 1, .005);
    }
}

// A scene of one_highlight() with images for its grain, many times across a pixel.
Scene textured_highlight(const std::string& grain) {
  Scene scene = one_highlight(QuadShape{{-50, 0, 50}, {100, 0, 0}, {0, 0, -100}});
  scene.shapes[0].gloss =
      parse_scene(
          R"({"shapes": [{"quad": {"u": [1, 0, 0], "v": [0, 1, 0], "corner": [0, 0, 0]}, "specular_roughness": 0.5, )" +
              grain + "}]}",
          "text.json")
          .shapes[0]
          .gloss;
  return scene;
}

// Claim: images of angles, 1 a full turn, and of directions, as those of a normal map, turn the tangent; over a footprint
// the axes are averaged, not the numbers: those of 3 and 178 degrees to one near 0, of crossed ones to almost isotropic
// facets; an image of anisotropy is its number. Source: the reflectance function. Tolerance: of half floats, .3 %. Fails if:
// crossed axes keep the anisotropy (1.3 %), or the tangent turns by twice the angle (20 %).
TEST(Anisotropy, ImagesTurnTheTangent) {
  const ScratchFolder folder;
  const auto image = [&](const std::string& name, const Bytes& even, const Bytes& odd) {
    put_png(folder.file(name), 64, 64, [&](int x, int) { return x % 2 == 0 ? even : odd; });
    return R"("texture": ")" + folder.file(name) + R"(", "uv_scale": [1000, 1000])";
  };
  const auto of_bytes = [](int value) { return Bytes{std::uint8_t(value), 0, 0}; };
  const std::string fixed = R"("specular_anisotropy": 0.7, "specular_rotation": )";
  const FacetAlphas facets = facet_alphas(.5f, .7f);
  const Vec3d x{1, 0, 0};
  const auto mean_of = [&](int a, int b) {
    std::complex<double> axis;
    for (const int byte : {a, b}) axis += std::polar(.5, 4 * kPi * byte / 255);
    return highlight(x, filtered_alphas(facets, float(std::abs(axis)), 0), std::arg(axis) / 2 * 180 / kPi);
  };
  const auto expect = [&](const std::string& grain, double expected) {
    EXPECT_NEAR(seen(textured_highlight(grain)) / expected, 1, 3e-3) << grain;
  };
  expect(fixed + "{" + image("even.png", of_bytes(25), of_bytes(25)) + "}",
         highlight(x, facets, 360 * 25 / 255.));
  const double direction = std::atan2(2 * 200 - 255, 2 * 230 - 255) * 180 / kPi;
  expect(fixed + "{" + image("d.png", {230, 200, 0}, {230, 200, 0}) + R"(, "channel": "rg"})",
         highlight(x, facets, direction));
  expect(fixed + "{" + image("opposed.png", {230, 200, 0}, {25, 55, 0}) + R"(, "channel": "rg"})",
         highlight(x, facets, direction));
  expect(fixed + "{" + image("near0.png", of_bytes(2), of_bytes(126)) + "}", mean_of(2, 126));
  expect(fixed + "{" + image("crossed.png", of_bytes(0), of_bytes(64)) + "}", mean_of(0, 64));
  expect(R"("specular_anisotropy": {)" + image("strength.png", of_bytes(100), of_bytes(156)) +
             R"(, "scale": 1.39453}, "specular_rotation": 35)",
         highlight(x));
}

// Claim: a far view of grain turned by up to 49 degrees is the mean of a near one: the covariances of slopes are averaged.
// Tolerance: the mean 3 %; each pixel 50 % at 99 %, as a sum of lobes is no lobe (median 10 %). Fails if: the facets keep
// their anisotropy (10 and 174 %), or the tangent turns by twice the angle (11 and 89 %).
TEST(Anisotropy, FarViewsAreTheMeanOfNearOnes) {
  const ScratchFolder folder;
  put_png(folder.file("angles.png"), 64, 64, [](int x, int y) {
    return Bytes{std::uint8_t((x * 7919 + y * 104729 + x * y * 31) % 71 - 35), 0, 0};
  });
  Scene scene = textured_highlight(R"("specular_anisotropy": 0.8, "specular_rotation": {"texture": ")" +
                                   folder.file("angles.png") + R"(", "uv_scale": [10, 10]})");
  scene.camera.field_of_view = 20;
  const auto picture = [&](int side, int samples) {
    scene.film.resolution = {side, side};
    scene.film.samples_per_pixel = samples;
    return cold_picture(scene);
  };
  const Image near = picture(128, 16), far = picture(8, 1);
  double mean = 0, all = 0;
  std::vector<double> errors;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      double block = 0;
      for (int i = 0; i < 256; ++i)
        block += double(channel(near, 16 * x + i % 16, 16 * y + i / 16, "specular.G")) / 256;
      const double one = double(channel(far, x, y, "specular.G"));
      errors.push_back(std::abs(one / block - 1));
      mean += block, all += one;
    }
  std::ranges::sort(errors);
  EXPECT_NEAR(all / mean, 1, .03);
  EXPECT_LT(errors[errors.size() * 99 / 100], .5);
}

// Claim: without anisotropy a rotation moves no bit. Fails if a frame is turned where nothing asks for it.
TEST(Anisotropy, NoneIsNone) {
  Scene plain = one_highlight(SphereShape{{}, 10});
  plain.lights.push_back({"all around", Surroundings{Rgb(1.0)}});
  plain.camera.field_of_view = 20;
  plain.film.resolution = {16, 16};
  plain.shapes[0].gloss->grain = {0, kDegrees};
  Scene none = plain;
  none.shapes[0].gloss->grain = {};
  EXPECT_EQ(cold_picture(plain).pixels, cold_picture(none).pixels);
}

}  // namespace
}  // namespace opaline::test
