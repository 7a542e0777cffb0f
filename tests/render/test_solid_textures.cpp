// SPDX-License-Identifier: GPL-3.0-or-later
// Textures by the position in space: noise, and images projected along three axes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "image/solid_noise.h"
#include "input/load_scene.h"
#include "opaline/error.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

/// A ball without UVs, turned, scaled and moved, with 2 mm per unit; as `shape` has it.
std::string ball_scene(const std::string& shape) {
  return R"({"mm_per_unit": 2, "shapes": [{"name": "ball", "sphere": {"radius": 5},
    "transform": [{"rotate": {"axis": [1, 2, 0], "degrees": 40}}, {"scale": [1, 1.5, 1]}, {"translate": [3, 0, 1]}], )" +
         shape + R"(}],
    "lights": [{"type": "directional", "direction": [0, 0, -1], "irradiance": 3}],
    "camera": {"position": [3, 0, 40], "look_at": [3, 0, 0], "field_of_view": 25},
    "film": {"resolution": [40, 40]}, "settings": {"method": "lambert"}})";
}

Vec3d layer_at(const Image& image, int x, int y, const std::string& layer, const std::string& parts) {
  Vec3d value;
  for (std::size_t c = 0; c < 3; ++c) value[c] = double(channel(image, x, y, layer + '.' + parts[c]));
  return value;
}

/// From the world to the space of the ball, by hand: backwards through its transform.
Vec3d in_ball(const Vec3d& world) {
  Vec3d p = world - Vec3d{6, 0, 2};
  p.y /= 1.5;
  const Vec3d axis = normalized(Vec3d{1, 2, 0});
  const double angle = -40 * kPi / 180;
  return p * std::cos(angle) + cross(axis, p) * std::sin(angle) +
         axis * (dot(axis, p) * (1 - std::cos(angle)));
}

// Claim: noise has its value at the point in the space of the shape, in scene units, whatever the transform, and needs no
// UVs. Source: SolidNoise at the layer P, by hand. Tolerance: .03, the filter of a pixel. Fails if the transform or the
// unit is left out.
TEST(SolidTextures, NoiseHasTheSpaceOfTheShape) {
  const ScratchFolder folder;
  const Image image = picture_of(
      folder,
      ball_scene(
          R"("reflectance": {"noise": "clouds", "size": 4, "octaves": 2, "low": [0.1, 0.2, 0.3], "high": 0.9})"));
  const SolidNoise noise({.size = 8, .octaves = 2, .low = {.1, .2, .3}, .high = {.9, .9, .9}});
  int seen = 0;
  double least = 1, most = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      if (channel(image, x, y, "A") < 1 || layer_at(image, x, y, "N", "XYZ").z < .5) continue;
      const Vec3d albedo = layer_at(image, x, y, "albedo", "RGB");
      const auto value = noise.at(in_ball(layer_at(image, x, y, "P", "XYZ")), 0);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(albedo[c], double(value[c]), .03) << x << ' ' << y;
      least = std::min(least, albedo.x);
      most = std::max(most, albedo.x);
      ++seen;
    }
  EXPECT_GT(seen, 300);
  EXPECT_GT(most - least, .3);
}

// Claim: noise on a mesh file is the same in scenes of other units, with all lengths alike. Source: scenes/README.md, sizes in
// scene units. Tolerance: 1e-4, single precision. Fails if the vertices of the file are taken in mm.
TEST(SolidTextures, NoiseOnMeshFilesFollowsTheUnit) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.obj"), "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
  const auto image = [&](const std::string& unit) {
    return picture_of(folder, R"({"mm_per_unit": )" + unit + R"(, "shapes": [{"file": "a.obj",
        "reflectance": {"noise": "clouds", "size": 0.4, "octaves": 2}}],
      "lights": [{"type": "directional", "direction": [0, 0, -1], "irradiance": 3}],
      "camera": {"position": [0, 0, 10], "field_of_view": 11}, "film": {"resolution": [24, 24], "pixel_type": "float"},
      "settings": {"method": "lambert"}})");
  };
  const Image one = image("1"), ten = image("10");
  double least = 1, most = 0;
  for (int y = 2; y < 22; ++y)
    for (int x = 2; x < 22; ++x) {
      EXPECT_NEAR(channel(ten, x, y, "R"), channel(one, x, y, "R"), 1e-4) << x << ' ' << y;
      least = std::min(least, double(channel(one, x, y, "R")));
      most = std::max(most, double(channel(one, x, y, "R")));
    }
  EXPECT_GT(most - least, .2);
}

// Claim: on the faces of a box, a projected image lies as on a wall: its width as given, upright, and unmirrored on the
// faces towards +x, +y and +z. Source: by hand, from the layer P. Tolerance: .02, a texel's quarter. Fails if an axis is
// mirrored or exchanged.
TEST(SolidTextures, ImagesLieOnWalls) {
  const ScratchFolder folder;
  put_exr(folder.file("ramp.exr"), 64, 64, [](int x, int y) {
    return std::array<double, 3>{(x + .5) / 64, (y + .5) / 64, .5};
  });
  for (const std::array<int, 3>& view : {std::array{0, 0, 1}, std::array{1, 0, 0}}) {
    const Image image =
        picture_of(folder, fmt::format(R"({{"shapes": [{{"box": {{"low": [1, 1, 1], "high": [9, 9, 9]}},
          "reflectance": {{"texture": "ramp.exr", "triplanar": 10}}}}],
          "lights": [{{"type": "directional", "direction": [-1, -1, -1], "irradiance": 3}}],
          "camera": {{"position": [{}, 5, {}], "look_at": [5, 5, 5], "field_of_view": 20}},
          "film": {{"resolution": [24, 24]}}, "settings": {{"method": "lambert"}}}})",
                                       5 + 40 * view[0], 5 + 40 * view[2]));
    int seen = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        if (channel(image, x, y, "A") < 1) continue;
        const Vec3d point = layer_at(image, x, y, "P", "XYZ"),
                    albedo = layer_at(image, x, y, "albedo", "RGB");
        const double right = view[2] ? point.x : 10 - point.z;
        if (std::abs(right - 5) > 3.5 || std::abs(point.y - 5) > 3.5) continue;
        EXPECT_NEAR(albedo.x, right / 10, .02) << x << ' ' << y;
        EXPECT_NEAR(albedo.y, 1 - point.y / 10, .02) << x << ' ' << y;
        ++seen;
      }
    EXPECT_GT(seen, 50);
  }
}

// Claim: projections blend to a constant where the image is one in each channel but one texel, so weights sum to 1. Fails
// if they are not normalised.
TEST(SolidTextures, ProjectionsBlendWithoutLoss) {
  const ScratchFolder folder;
  put_exr(folder.file("even.exr"), 64, 64, [](int x, int y) {
    return std::array<double, 3>{.6, x == 0 && y == 0 ? .31 : .3, .2};
  });
  const Image image =
      picture_of(folder, ball_scene(R"("reflectance": {"texture": "even.exr", "triplanar": 1000})"));
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x)
      if (channel(image, x, y, "A") == 1) {
        EXPECT_NEAR(channel(image, x, y, "albedo.R"), .6, 2e-3) << x << ' ' << y;
      }
}

// Claim: a bump of noise turns the normal by the gradient of the height along the surface. Source: SolidNoise, and the
// ball's own normal, by hand. Tolerance: 1 degree; heights turn it by up to 20. Fails if the gradient is not transformed
// to the world, or if its component along the normal is kept.
TEST(SolidTextures, NoiseBumpsNormals) {
  const ScratchFolder folder;
  const Image plain = picture_of(folder, ball_scene(R"("reflectance": 0.5)"));
  const Image image = picture_of(
      folder,
      ball_scene(
          R"("bump_map": {"noise": "clouds", "size": 3, "octaves": 1, "scale": 1.5}, "reflectance": 0.5)"));
  const SolidNoise noise({.size = 6, .octaves = 1});
  double largest = 0;
  for (int y = 10; y < 30; ++y)
    for (int x = 14; x < 26; ++x) {
      const Vec3d own = layer_at(plain, x, y, "N", "XYZ"), point = layer_at(plain, x, y, "P", "XYZ");
      Vec3d rise;
      for (std::size_t c = 0; c < 3; ++c) {
        Vec3d before = point, behind = point;
        before[c] -= .01;
        behind[c] += .01;
        rise[c] = 3 * double(noise.at(in_ball(behind), 0)[0] - noise.at(in_ball(before), 0)[0]) / .02;
      }
      const Vec3d expected = normalized(own - (rise - own * dot(rise, own)));
      const double error =
          std::acos(std::min(1., dot(expected, layer_at(image, x, y, "N", "XYZ")))) * 180 / kPi;
      EXPECT_LT(error, 1) << x << ' ' << y;
      largest = std::max(largest, std::acos(std::min(1., dot(expected, own))) * 180 / kPi);
    }
  EXPECT_GT(largest, 10);
}

// Claim: a medium with a colour of noise is defined by the mean, its light varies, and moving the shape with its light and
// camera moves the pattern with it. Fails if a stage's key lacks the space of the shape.
TEST(SolidTextures, MediaCarryNoise) {
  const ScratchFolder folder;
  const std::string text =
      R"({"media": {"stone": {"subsurface_color": {"noise": "veins", "size": 6, "low": 0.8,
      "high": [0.2, 0.3, 0.4]}, "subsurface_radius": 1}},
    "shapes": [{"name": "ball", "sphere": {"radius": 5}, "medium": "stone"}],
    "lights": [{"type": "directional", "direction": [0, 0, -1], "irradiance": 3}],
    "camera": {"position": [0, 0, 40], "look_at": [0, 0, 0], "field_of_view": 16},
    "film": {"resolution": [24, 24]}, "settings": {"method": "volume_diffusion"}})";
  Session session;
  const auto shown = [&](const std::vector<std::string>& overrides) {
    return picture_of(session, with_few_triangles(parse_scene(text, folder.file("scene.json"), overrides)));
  };
  const Image image = shown({});
  const Scene scene = parse_scene(text, folder.file("scene.json"));
  const auto& artist = std::get<ArtistMedium>(scene.media[0].coefficients);
  const SolidNoise noise(
      {.pattern = NoisePattern::veins, .size = 6, .low = {.8, .8, .8}, .high = {.2, .3, .4}});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(artist.subsurface_color[c], noise.mean()[c], 1e-12);
  const std::vector<std::string> moved{"shapes.0.transform=[{\"translate\": [9, 0, 0]}]",
                                       "camera.position=[9, 0, 40]", "camera.look_at=[9, 0, 0]"};
  const Image same = shown(moved);
  std::vector<std::string> still = moved;
  still[0] = "shapes.0.sphere.center=[9, 0, 0]";
  const Image other = shown(still),
              cold = cold_picture(with_few_triangles(parse_scene(text, folder.file("scene.json"), still)));
  double kept = 0, changed = 0, warm = 0;
  for (int y = 6; y < 18; ++y)
    for (int x = 6; x < 18; ++x) {
      kept = std::max(kept, std::abs(double(channel(image, x, y, "R") / channel(same, x, y, "R")) - 1));
      warm = std::max(warm, std::abs(double(channel(cold, x, y, "R") / channel(other, x, y, "R")) - 1));
      changed =
          std::max(changed, std::abs(double(channel(image, x, y, "R") / channel(other, x, y, "R")) - 1));
    }
  EXPECT_LT(kept, .05);
  EXPECT_LT(warm, .05);
  EXPECT_GT(changed, .2);
}

// Claim: keys without an effect, and normal maps without UVs, are refused with the reason.
TEST(SolidTextures, MistakesAreRefused) {
  const ScratchFolder folder;
  put_exr(folder.file("even.exr"), 4, 4, [](int x, int) { return std::array<double, 3>{.1 * x, .2, .3}; });
  const auto message = [&](const std::string& shape) -> std::string {
    try {
      parse_scene(ball_scene(shape), folder.file("scene.json"));
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  };
  const auto fails = [&](const std::string& shape, const std::string& part) {
    EXPECT_NE(message(shape).find(part), std::string::npos) << shape << ": " << message(shape);
  };
  fails(R"("reflectance": {"noise": "clouds"})", "size");
  fails(R"("reflectance": {"noise": "stripes", "size": 1})", "one of clouds, veins");
  fails(R"("reflectance": {"noise": "clouds", "texture": "even.exr", "size": 1})", "texture");
  fails(R"("reflectance": {"noise": "clouds", "size": 0})", "size");
  fails(R"("reflectance": {"noise": "clouds", "size": 1, "uv_scale": [2, 2]})",
        "uv_scale' has no effect with 'noise'");
  fails(R"("reflectance": {"texture": "even.exr", "triplanar": 3, "uv_rotation": 2})",
        "has no effect with 'triplanar'");
  fails(R"("reflectance": {"texture": "even.exr", "octaves": 2})", "has no effect without 'noise'");
  fails(R"("normal_map": {"texture": "even.exr", "triplanar": 3}, "reflectance": 0.5)", "mapped by UVs");
  fails(R"("normal_map": {"noise": "clouds", "size": 3}, "reflectance": 0.5)", "mapped by UVs");
  fails(
      R"("normal_map": {"texture": "even.exr", "detail": [{"noise": "clouds", "size": 3}]}, "reflectance": 0.5)",
      "mapped by UVs");
  fails(
      R"("normal_map": {"texture": "even.exr", "detail": [{"texture": "even.exr", "triplanar": 3}]}, "reflectance": 0.5)",
      "mapped by UVs");
  fails(R"("bump_map": {"noise": "clouds", "size": 3, "channel": "a"}, "reflectance": 0.5)",
        "not in 'noise'");
  EXPECT_EQ(message(R"("reflectance": {"noise": "clouds", "size": 3, "low": 0.4, "high": 0.4})"), "none");
}

}  // namespace
}  // namespace opaline::test
