// SPDX-License-Identifier: GPL-3.0-or-later
#include "../core/scratch_folder.h"
#include "image/texture_file.h"
#include "scene/scene_properties.h"
#include "scene_test.h"
#include "support/pictures.h"

namespace opaline {
namespace {

struct TextureFolder {
  ScratchFolder folder;

  TextureFolder() {
    test::put_png(folder.file("two.png"), 2, 1, [](int x, int) {
      return x == 0 ? test::Bytes{255, 128, 0} : test::Bytes{255, 0, 0};
    });
    test::put_png(folder.file("even.png"), 2, 1, test::Bytes{128, 128, 128});
  }
  Scene scene(const std::string& text) const { return parse_scene(text, folder.file("scene.json"), {}); }
  Error error(const std::string& text) const {
    try {
      scene(text);
    } catch (const Error& failure) {
      return failure;
    }
    ADD_FAILURE() << "no error for: " << text;
    return bad_file("", "");
  }
};

std::string shape(const std::string& keys) {
  return "{\"shapes\": [\n{\"sphere\": {\"radius\": 1}, " + keys + "}]}";
}
std::string medium(const std::string& keys) {
  return "{\"media\": {\n\"m\": {" + keys + "}}}";
}

// Claim: a texture stands where a constant may; its scale, channel and laying are read; its medium is that of its mean,
// and its texels are over that. Tolerance: none; of the mean 1e-12. Fails if a key is passed over.
TEST(SceneTextures, AreRead) {
  const TextureFolder files;
  const Scene scene = files.scene(
      R"({"media": {"m": {"subsurface_color": {"texture": "two.png"}, "subsurface_radius": 1,
          "specular_roughness": {"texture": "two.png", "channel": "g", "scale": 0.5}, "texture_mix": "post"}},
          "shapes": [{"quad": {"corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0]},
          "reflectance": {"texture": "two.png", "scale": [1, 0.5, 0.25], "uv_scale": [2, 3], "uv_offset": [0.5, 0.25],
          "uv_rotation": 90}, "normal_map": {"texture": "two.png", "scale": 2},
          "bump_map": {"texture": "two.png", "scale": 0.5, "channel": "g"}}], "mm_per_unit": 10})");
  const Medium& medium = scene.media[0];
  const Rgb color = std::get<ArtistMedium>(medium.coefficients).subsurface_color;
  EXPECT_EQ(color.x, 1);
  EXPECT_NEAR(color.y, test::linear_of_byte(128) / 2, 1e-12);
  EXPECT_EQ(color.z, 0);
  ASSERT_TRUE(medium.tint_texture && medium.roughness_texture);
  EXPECT_NEAR(medium.tint_texture->scale.y * color.y, 1, 1e-12);
  EXPECT_EQ(medium.roughness_texture->channel, 1u);
  EXPECT_EQ(medium.roughness_texture->scale.x, .5);
  EXPECT_EQ(medium.texture_mix, TextureMix::post);
  const Texture& texture = scene.shapes[0].reflectance_texture.value();
  EXPECT_EQ(texture.scale, Rgb(1, .5, .25));
  EXPECT_EQ(texture.uv_scale, (std::array<double, 2>{2, 3}));
  EXPECT_EQ(texture.uv_offset, (std::array<double, 2>{.5, .25}));
  EXPECT_EQ(texture.uv_rotation, 90);
  EXPECT_EQ(scene.shapes[0].reflectance, Rgb(1));
  EXPECT_EQ(scene.shapes[0].normal_map->scale.x, 2);
  EXPECT_EQ(scene.shapes[0].bump_map->scale.x, 5);
  EXPECT_EQ(scene.shapes[0].bump_map->channel, 1u);
  EXPECT_TRUE(needs_uvs(scene, scene.shapes[0]));
}

// Claim: of a texture of radii the medium has the mean, numbers as they are, times its scale and subsurface_radius_scale; its
// texels are over that. It takes UVs. Tolerance: 1e-12. Fails if: numbers are taken for sRGB, or the scale is lost or met twice.
TEST(SceneTextures, OfRadiiAreRead) {
  const TextureFolder files;
  const Scene scene = files.scene(
      R"({"media": {"m": {"subsurface_color": {"texture": "two.png"}, "texture_mix": "medium",
          "subsurface_radius": {"texture": "two.png", "scale": 3}, "subsurface_radius_scale": [1, 0.5, 1]}},
          "shapes": [{"sphere": {"radius": 1}, "medium": "m"}]})");
  const Medium& medium = scene.media[0];
  const Rgb radius = std::get<ArtistMedium>(medium.coefficients).subsurface_radius;
  EXPECT_NEAR(radius.x, 3, 1e-12);
  EXPECT_NEAR(radius.y, 3 * 128 / 255. / 2 * .5, 1e-12);
  EXPECT_EQ(radius.z, 0);
  ASSERT_TRUE(medium.radius_texture && medium.tint_texture);
  EXPECT_NEAR(medium.radius_texture->scale.y * 128 / 255. / 2, 1, 1e-12);
  EXPECT_TRUE(needs_uvs(scene, scene.shapes[0]));
  EXPECT_TRUE(has_color_inside(medium));
  EXPECT_TRUE(varies_inside(medium));
}

// Claim: a texture of one colour is read as that colour: the scenes are equal. Fails if it stays a texture.
TEST(SceneTextures, OfOneColourAreConstants) {
  const TextureFolder files;
  const Scene textured = files.scene(shape(R"("reflectance": {"texture": "even.png", "scale": 0.5})"));
  EXPECT_FALSE(textured.shapes[0].reflectance_texture);
  EXPECT_EQ(textured.shapes[0].reflectance, Rgb(test::linear_of_byte(128) * .5));
  EXPECT_FALSE(needs_uvs(textured, textured.shapes[0]));
  EXPECT_EQ(files.scene(shape(R"("reflectance": {"texture": "even.png"})")),
            files.scene(shape(R"("reflectance": "#808080")")));
  const Medium wax =
      files
          .scene(medium(R"("texture_mix": "medium", "subsurface_color": {"texture": "even.png"},
                 "subsurface_radius": {"texture": "even.png", "scale": 2})"))
          .media[0];
  EXPECT_FALSE(wax.tint_texture || wax.radius_texture);
  EXPECT_NEAR(std::get<ArtistMedium>(wax.coefficients).subsurface_radius.x, 2 * 128 / 255., 1e-6);
}

// Claim: what is wrong with a texture is said at its place in the scene, line 2 here, with the file's name. Fails if a
// missing file waits for the picture, or a key that cannot vary takes a texture.
TEST(SceneTextures, AreRefusedWhereTheyStand) {
  const TextureFolder files;
  const auto expect = [&](const std::string& text, const std::vector<std::string>& fragments) {
    const Error error = files.error(text);
    EXPECT_EQ(error.line, 2) << error.what();
    expect_fragments(error, fragments);
  };
  expect(shape(R"("reflectance": {"texture": "absent.png"})"), {"absent.png", "scene.json"});
  expect(shape(R"("reflectance": {"texture": "two.png", "chanel": "g"})"), {"unknown key 'chanel'"});
  expect(shape(R"("reflectance": {"texture": "two.png", "channel": "g"})"), {"is a colour"});
  expect(shape(R"("normal_map": {"texture": "two.png", "channel": "g"})"), {"three numbers"});
  const std::string rotation = R"("specular_roughness": 0.5, "specular_rotation": {"texture": "two.png", )";
  expect(shape(rotation + R"("scale": 2})"), {"scale", "no effect on angles"});
  expect(shape(rotation + R"("channel": "a"})"), {"channel", "r, g or b"});
  expect(shape(rotation + R"("triplanar": 1})"), {"specular_rotation", "UVs"});
  expect(shape(R"("specular_roughness": {"texture": "two.png", "channel": "rg"})"), {"channel", "direction"});
  expect(shape(R"("reflectance": {"texture": "two.png", "uv_scale": [1]})"), {"uv_scale", "2 numbers"});
  expect(shape(R"("reflectance": {"scale": 1})"), {"texture"});
  expect(shape(R"("reflectance": {"texture": "even.png", "scale": 9})"), {"reflectance", "out of range"});
  expect(shape(R"("specular_ior": 1.4)"), {"specular_ior", "diffuse"});
  expect(medium(R"("subsurface_color": 0.5, "subsurface_radius": {"texture": "two.png", "channel": "g"})"),
         {"subsurface_radius", "three numbers"});
  expect(medium(R"("subsurface_color": 0.5, "subsurface_radius": {"texture": "even.png", "scale": -1})"),
         {"subsurface_radius"});
  expect(medium(R"("sigma_a": 0.1, "sigma_s_prime": {"texture": "two.png"})"), {"sigma_s_prime"});
  expect(medium(R"("preset": "marble", "tint": 0.5, "texture_mix": "medium")"),
         {"texture_mix", "subsurface_color"});
  expect(medium(R"("subsurface_color": {"texture": "two.png"}, "subsurface_radius": 1, "tint": 0.5)"),
         {"tint", "subsurface_color"});
}

// Claim: texels out of range are named at the texture's place in the scene, by pixel and value. Fails if the error waits for the
// render, without a line.
TEST(SceneTextures, TexelsOutOfRangeAreNamedInTheScene) {
  const TextureFolder files;
  test::put_exr(files.folder.file("big.exr"), 4, 2, [](int x, int y) {
    return std::array<double, 3>{.5, x == 3 && y == 1 ? -2e30 : .5, .5};
  });
  const Error error = files.error(shape(R"("reflectance": {"texture": "big.exr"})"));
  EXPECT_EQ(error.line, 2) << error.what();
  expect_fragments(error, {"big.exr", "scene.json", "pixel (3, 1) is not finite or above 1e30: -2e+30"});
}

// Claim: a constant texture outside the range is an error naming the value, the image and the range. Fails if: only the key is
// named.
TEST(SceneTextures, ConstantOutOfRangeIsNamed) {
  const TextureFolder files;
  test::put_exr(files.folder.file("even.exr"), 4, 2, [](int, int) { return std::array<double, 3>{3, 3, 3}; });
  expect_fragments(files.error(shape(R"("reflectance": {"texture": "even.exr"})")),
                   {"is out of range: 3 at every texel of", "even.exr", "values from 0 to 1"});
}

// Claim: colours above 1, rendered as 1, are one warning by their number and the largest; those that a scale brings below 1, and
// those over a mean, are not. Fails if a reflectance of 40 is rendered as 1 in silence.
TEST(SceneTextures, ColoursAboveOneAreAWarning) {
  const TextureFolder files;
  test::put_exr(files.folder.file("bright.exr"), 4, 2, [](int x, int) {
    return std::array<double, 3>{.5, x == 3 ? 40 : .5, .5};
  });
  const auto warnings = [&](const std::string& text) { return files.scene(text).warnings; };
  const std::string path = files.folder.file("bright.exr");
  EXPECT_EQ(warnings(shape(R"("reflectance": {"texture": "bright.exr"})")),
            std::vector{path + ": 2 of 8 texels have a colour above 1, rendered as 1; the largest is 40"});
  EXPECT_EQ(warnings(shape(R"("reflectance": {"texture": "bright.exr", "scale": 0.1})")),
            std::vector{path + ": 2 of 8 texels times their scale have a colour above 1, rendered as 1; the "
                               "largest is 4"});
  EXPECT_EQ(warnings(shape(R"("reflectance": {"texture": "bright.exr", "scale": 0.025})")),
            std::vector<std::string>{});
  EXPECT_EQ(warnings(R"({"media": {"m": {"subsurface_color": {"texture": "bright.exr", "scale": 0.02},
                         "subsurface_radius": 1}}, "shapes": [{"sphere": {"radius": 1}, "medium": "m"}]})"),
            std::vector<std::string>{});
}

}  // namespace
}  // namespace opaline
