// SPDX-License-Identifier: GPL-3.0-or-later
// Textures as pictures show them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/scratch_folder.h"
#include "input/load_scene.h"
#include "methods/direct/direct.h"
#include "session/session_records.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

/// A quad that fills the picture, seen and lit from the front; `surface` are its keys.
std::string quad_scene(const std::string& surface, const std::string& settings = "") {
  return R"({"shapes": [{"quad": {"corner": [-1, -1, 0], "u": [2, 0, 0], "v": [0, 2, 0]}, )" + surface +
         R"(}], "lights": [{"type": "directional", "direction": [0, 0, -1], "irradiance": 3}],
         "camera": {"position": [0, 0, 10], "field_of_view": 11.3},
         "film": {"resolution": [16, 16]}, "settings": {)" +
         settings + "}}";
}

/// A ball in even light; `medium` are keys of its medium, beside its coefficients.
std::string ball_scene(const std::string& medium, double mean_free_path,
                       const std::string& method = "hierarchical", const std::string& shape = "") {
  return R"({"media": {"m": {"sigma_a": 0, "specular_ior": 1.4, "sigma_s_prime": )" +
         std::to_string(1 / mean_free_path) + ", " + medium + R"(}},
         "shapes": [{"sphere": {"radius": 10}, "medium": "m")" +
         shape + R"(}], "surroundings": 1,
         "camera": {"position": [0, 0, 60], "field_of_view": 16},
         "film": {"resolution": [33, 33]},
         "settings": {"samples": 20000, "method": ")" +
         method + R"("}})";
}

constexpr const char* kColorOf = R"("reflectance": )";

// Claim: a grey picture with alpha is the grey one, 0.3035 in the mean of a part; a picture whose data window lies
// within its display window is the one that has the rest written as 0. Tolerance: none between images; 0.0005. Fails if
// alpha stands for green, or tiles of the texture are scattered.
TEST(Textures, OfAnyChannelsAndWindowsAreAlike) {
  const auto image_of = [](const std::string& scene, const std::string& texture) {
    const std::vector<std::string> other{"shapes.0.reflectance.texture=" + texture};
    return Prepared(load_scene(OPALINE_TEST_INPUTS "/" + scene, other)).picture();
  };
  const Image grey = image_of("grey_alpha.json", "v_la255.png");
  EXPECT_TRUE(same_pixels(grey, image_of("grey_alpha.json", "v_l.png")));
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (std::size_t y = 20; y < 40; ++y)
      for (std::size_t x = 20; x < 40; ++x)
        sum += double(grey.pixels[(y * 64 + x) * grey.channels.size() + c]);
    EXPECT_NEAR(sum / 400, .3035, .0005) << c;
  }
  const Image window = image_of("data_window.json", "t_dw.exr");
  EXPECT_TRUE(same_pixels(window, image_of("data_window.json", "t_pad.exr")));
}

// Claim: an image from black on the left to white on the right covers a quad from edge to edge; filters do not mix its
// sides there. Tolerance: 1e-3 of the plain colours, the outermost of 16 pixels. Fails if the image is repeated (half grey).
TEST(Textures, EndAtTheEdgesOfAQuad) {
  const ScratchFolder folder;
  put_png(folder.file("sides.png"), 2, 1, [](int column, int) {
    return column == 0 ? Bytes{0, 0, 0} : Bytes{255, 255, 255};
  });
  const Image image =
      picture_of(folder, quad_scene(R"("reflectance": {"texture": "sides.png"})", R"("method": "lambert")"));
  const auto at = [&](std::size_t x) { return double(image.pixels[(8 * 16 + x) * image.channels.size()]); };
  EXPECT_NEAR(at(1), 0, 1e-3);
  EXPECT_NEAR(at(14), 3 / std::numbers::pi, 1e-3);
}

// Claim: the plan counts the image reader's memory for constant textures, too. Source: make_plan.cpp, 105 MB in
// addition to the 60 MB of all other libraries. Fails if only textures with lookups count.
TEST(Textures, ThatAreConstantsAreInThePlan) {
  const ScratchFolder folder;
  put_png(folder.file("grey.png"), 4, 4, Bytes{128, 128, 128});
  const Scene scene =
      parse_scene(quad_scene(R"("reflectance": {"texture": "grey.png"})"), folder.file("scene.json"), {});
  ASSERT_FALSE(scene.shapes[0].reflectance_texture);
  EXPECT_GE(Prepared(scene).plan.bytes, 105'000'000u + 60'000'000u);
}

// Claim: a texture whose texels are alike is the constant, to the last bit of the picture, for every value that may be a
// texture; and one that is not is not. Fails if constants are looked up through halves.
TEST(Textures, OfOneTexelAreConstants) {
  const ScratchFolder folder;
  put_png(folder.file("grey.png"), 4, 4, Bytes{128, 128, 128});
  const std::string colour = R"({"texture": "grey.png"})";
  EXPECT_TRUE(same_pixels(picture_of(folder, quad_scene(kColorOf + colour)),
                          picture_of(folder, quad_scene(kColorOf + std::string("\"#808080\"")))));
  const std::vector<std::string> few{"settings.samples=2000"};
  const auto ball = [&](const std::string& keys) { return picture_of(folder, ball_scene(keys, .5), few); };
  EXPECT_TRUE(same_pixels(ball(R"("tint": )" + colour), ball(R"("tint": "#808080")")));
  EXPECT_FALSE(same_pixels(ball(R"("tint": )" + colour), ball(R"("tint": "#818181")")));
  EXPECT_TRUE(same_pixels(ball(R"("specular_roughness": {"texture": "grey.png"})"),
                          ball(R"("specular_roughness": 0.50196078431372548)")));
  const auto artist = [&](const std::string& color) {
    std::string text = ball_scene("", .5);
    const std::size_t begin = text.find("\"sigma_a\""), end = text.find("}", begin);
    text.replace(begin, end - begin, R"("subsurface_radius": 0.5, "subsurface_color": )" + color);
    return picture_of(folder, text, few);
  };
  EXPECT_TRUE(same_pixels(artist(colour), artist("\"#808080\"")));
}

// Claim: each half of a quad under a texture of two colours is as bright as the quad in that colour. Tolerance: .1 %,
// halves in the texture cache. Fails if u is turned round, colours are not linearized, or the edge is not in the middle.
TEST(Textures, LieAsUvsSay) {
  const ScratchFolder folder;
  put_png(folder.file("two.png"), 64, 64, [](int x, int) {
    return x < 32 ? Bytes{200, 100, 50} : Bytes{30, 60, 250};
  });
  const Image both = picture_of(folder, quad_scene(R"("reflectance": {"texture": "two.png"})"));
  const Image left = picture_of(folder, quad_scene(R"("reflectance": "#c86432")"));
  const Image right = picture_of(folder, quad_scene(R"("reflectance": "#1e3cfa")"));
  const Image repeated = picture_of(
      folder,
      quad_scene(R"("reflectance": {"texture": "two.png", "uv_scale": [0.5, 1], "uv_offset": [0.5, 0]})"));
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      for (const char* name : {"R", "G", "B", "albedo.R"}) {
        const double expected = channel(x < 8 ? left : right, x, y, name);
        if (x < 7 || x > 8) {
          EXPECT_NEAR(channel(both, x, y, name), expected, 1e-3 * expected) << x << name;
        }
        EXPECT_NEAR(channel(repeated, x, y, name), channel(right, x, y, name), 2e-3) << x << name;
      }
}

// Claim: a set of tiles lies side by side on a quad whose UVs span two of them; where they reach a tile that is not there,
// that is an error at the texture's line, naming the tile. Fails if tiles are taken for one picture, a missing one is black, or
// tiles of one colour fill it.
TEST(Textures, OfTilesNeedThemAll) {
  const ScratchFolder folder;
  put_png(folder.file("p.1001.png"), 4, 4, Bytes{255, 0, 0});
  put_png(folder.file("p.1002.png"), 4, 4, Bytes{0, 255, 0});
  put_bytes(folder.file("q.obj"),
            "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 2 0\nvt 0 1\nvt 1 "
            "1\nvt 2 1\n"
            "f 1/1 5/2 6/5 4/4\nf 5/2 2/3 3/6 6/5\n");
  std::string text = quad_scene(R"("reflectance": {"texture": "p.<UDIM>.png", "color_space": "linear"})");
  const std::size_t begin = text.find("\"quad\""), end = text.find("}, ", begin);
  text.replace(begin, end + 1 - begin, "\"file\": \"q.obj\"");
  const Image image = picture_of(folder, text);
  EXPECT_GT(channel(image, 3, 8, "R"), .5);
  EXPECT_EQ(channel(image, 3, 8, "G"), 0);
  EXPECT_GT(channel(image, 12, 8, "G"), .5);
  EXPECT_EQ(channel(image, 12, 8, "R"), 0);
  std::filesystem::remove(folder.file("p.1002.png"));
  for (const Bytes& color : {Bytes{0, 255, 0}, Bytes{255, 0, 0}}) {  // the second is that of all tiles
    put_png(folder.file("p.1003.png"), 4, 4, color);
    try {
      picture_of(folder, text);
      FAIL();
    } catch (const Error& failure) {
      EXPECT_EQ(failure.line, 1) << failure.what();
      EXPECT_NE(std::string(failure.what()).find("1002"), std::string::npos) << failure.what();
    }
  }
}

// Claim: a checker too fine for the pixels is its mean in each of them, at one ray a pixel. Tolerance: .5 %. Fails if
// lookups have no footprint (then pixels are black or white), or sizes are made of sRGB numbers.
TEST(Textures, AreFilteredFromAfar) {
  const ScratchFolder folder;
  put_png(folder.file("checker.png"), 512, 512, [](int x, int y) {
    return (x + y) % 2 == 0 ? Bytes{255, 255, 255} : Bytes{0, 0, 0};
  });
  const Image even = picture_of(folder, quad_scene(R"("reflectance": 0.5)"));
  const Image checker = picture_of(folder, quad_scene(R"("reflectance": {"texture": "checker.png"})"));
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      EXPECT_NEAR(channel(checker, x, y, "G") / channel(even, x, y, "G"), 1, .005) << x << ' ' << y;
}

// Claim: a flat normal map, (128, 128, 255), changes no bit; one that leans to the right by 45 degrees turns light from
// there into light from the front, and leaning up and down differ as they should. Tolerance: 1 %, 8 bits. Fails if 128 is
// no zero, axes are exchanged, or green points down.
TEST(Textures, BendNormals) {
  const ScratchFolder folder;
  put_png(folder.file("flat.png"), 4, 4, Bytes{128, 128, 255});
  const int half = int(std::lround(127.5 + 127.5 * std::sqrt(.5)));
  const auto lean = [&](const char* name, int x, int y) {
    put_png(folder.file(name), 4, 4, Bytes{128 + (half - 128) * x, 128 + (half - 128) * y, half});
  };
  lean("right.png", 1, 0);
  lean("up.png", 0, 1);
  const auto lit = [&](const std::string& keys, const char* from) {
    return picture_of(folder, quad_scene("\"reflectance\": 0.5" + keys),
                      {std::string("lights.0.direction=") + from});
  };
  EXPECT_TRUE(
      same_pixels(lit(R"(, "normal_map": {"texture": "flat.png"})", "[0, 0, -1]"), lit("", "[0, 0, -1]")));
  const double front = channel(lit("", "[0, 0, -1]"), 8, 8, "G");
  const auto seen = [&](const char* map, const char* from) {
    return channel(lit(std::string(R"(, "normal_map": {"texture": ")") + map + "\"}", from), 8, 8, "G") /
           front;
  };
  EXPECT_NEAR(seen("right.png", "[-1, 0, -1]"), 1, .01);
  EXPECT_NEAR(seen("right.png", "[1, 0, -1]"), 0, .01);
  EXPECT_NEAR(seen("up.png", "[0, -1, -1]"), 1, .01);
  EXPECT_NEAR(seen("up.png", "[0, 1, -1]"), 0, .01);
  EXPECT_NEAR(seen("up.png", "[-1, 0, -1]"), .5, .01);
}

// Claim: under a tint of a and b on its two sides, in even light, a ball far larger than light spreads in it sends out
// a M and b M (M without a tint) away from their border, whatever the mix; on the border a M and b M, sharply, by "post",
// (a + b)/2 M on both sides by "pre", root(a) (root a + root b)/2 M by "split". Source: symmetry about the border.
// Tolerance: 2 %, of 80k samples; 10 % on the border, where which samples lie on which side is chance. Fails if the
// exponents are exchanged, the tint is met twice, or not where light enters.
TEST(Textures, MixAsTheySay) {
  const ScratchFolder folder;
  const double a = 1, b = linear_of_byte(140), root_a = 1, root_b = std::sqrt(b);
  put_png(folder.file("sides.png"), 4096, 4, [](int x, int) {
    return x < 2048 ? Bytes{255, 255, 255} : Bytes{140, 140, 140};
  });
  for (const std::string method : {"hierarchical", "lambert", "volume_diffusion"}) {
    Session tinted, plain;
    const auto value = [&](Session& session, const std::string& tint, int x,
                           const std::string& field_of_view) {
      const std::vector<std::string> overrides{
          "media.m.sigma_a=0.3", "settings.samples=80000", "camera.field_of_view=" + field_of_view,
          "film.crop=[" + std::to_string(x) + ",16," + std::to_string(x + 1) + ",17]"};
      session.edit(with_few_triangles(
          parse_scene(ball_scene(tint, .5, method), folder.file("scene.json"), overrides)));
      return double(channel(session.render().image, 0, 0, "diffuse.G"));
    };
    for (const std::string mix : {"pre", "post", "split"}) {
      SCOPED_TRACE(method + ' ' + mix);
      const std::string keys = R"("tint": {"texture": "sides.png"}, "texture_mix": ")" + mix + '"';
      const auto ratio = [&](int x, const std::string& field_of_view) {
        return value(tinted, keys, x, field_of_view) / value(plain, "\"tint\": 1", x, field_of_view);
      };
      EXPECT_NEAR(ratio(6, "16"), a, .02);
      EXPECT_NEAR(ratio(26, "16"), b, .02);
      if (method == "lambert") continue;
      const double left = ratio(15, "1"), right = ratio(17, "1");  // .03 mm from the border
      const double expected_left = mix == "post"  ? a
                                   : mix == "pre" ? (a + b) / 2
                                                  : root_a * (root_a + root_b) / 2;
      const double expected_right = mix == "post"  ? b
                                    : mix == "pre" ? (a + b) / 2
                                                   : root_b * (root_a + root_b) / 2;
      EXPECT_NEAR(left / expected_left, 1, .1);
      EXPECT_NEAR(right / expected_right, 1, .1);
    }
  }
}

// Claim: random walks are tinted where light enters and where it leaves: an even tint of 1/4 leaves a quarter, whichever
// the mix, and a tint of two sides each its own away from the border. Tolerance: rounding for the even one, whose walks
// are the same; 10 % for sides, the walks' noise. Fails if walks start without the tint, or are kept under a key without
// the texture.
TEST(Textures, TintRandomWalks) {
  const ScratchFolder folder;
  put_png(folder.file("sides.png"), 512, 4, [](int x, int) {
    return x < 256 ? Bytes{255, 255, 255} : Bytes{140, 140, 140};
  });
  Session session;
  const auto picture = [&](const std::string& keys) {
    session.edit(parse_scene(ball_scene(keys, .5, "volume"), folder.file("scene.json"),
                             std::vector<std::string>{"media.m.sigma_a=0.3", "settings.samples=400"}));
    return session.render().image;
  };
  const auto value = [](const Image& image, int x) { return double(channel(image, x, 16, "diffuse.G")); };
  const Image plain = picture("\"tint\": 1");
  for (const std::string mix : {"pre", "post", "split"}) {
    const Image even = picture(R"("tint": 0.25, "texture_mix": ")" + mix + '"');
    const Image sides = picture(R"("tint": {"texture": "sides.png"}, "texture_mix": ")" + mix + '"');
    for (const int x : {6, 16, 26}) EXPECT_NEAR(value(even, x) / value(plain, x), .25, 1e-4) << mix;
    EXPECT_NEAR(value(sides, 6) / value(plain, 6), 1, .1) << mix;
    EXPECT_NEAR(value(sides, 26) / value(plain, 26) / linear_of_byte(140), 1, .1) << mix;
  }
}

// Claim: `direct` and `hierarchical` agree under a texture, whatever the mix. Tolerance: .5 % of the mean, 4 % a pixel,
// which is the noise of 1024 entries. Fails if one of them
// tints at another place.
TEST(Textures, AreTheSameByDirect) {
  const ScratchFolder folder;
  put_png(folder.file("stripes.png"), 64, 32, [](int x, int) {
    return x / 8 % 2 == 0 ? Bytes{255, 220, 200} : Bytes{160, 120, 100};
  });
  for (const std::string mix : {"pre", "split"}) {
    const std::string keys = R"("tint": {"texture": "stripes.png"}, "texture_mix": ")" + mix + '"';
    const std::string crop = "film.crop=[8,8,25,25]";
    const Image tree = picture_of(folder, ball_scene(keys, 1), {crop});
    const Image direct =
        picture_of(folder, ball_scene(keys, 1, "direct"), {crop, "settings.entry_samples=1024"});
    double sum = 0, of_direct = 0, difference = 0;
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 17; ++x) {
        sum += channel(tree, x, y, "diffuse.G");
        of_direct += channel(direct, x, y, "diffuse.G");
        difference += std::abs(channel(tree, x, y, "diffuse.G") - channel(direct, x, y, "diffuse.G"));
      }
    EXPECT_NEAR(sum / of_direct, 1, .005) << mix;
    EXPECT_LT(difference / of_direct, .04) << mix;
  }
}

// Claim: what sends back all light is not to be told from its surroundings: a ball of albedo 1 and a small mean free path,
// under a texture of subsurface_color that is white but for 1e-7; under one of roughness, too, but for noise. Tolerance:
// .5 % in every pixel; 1 % over the picture with the noise of 64 facets. Fails if a texel over the mean is met twice, or
// what a rough boundary mirrors is not missing below.
TEST(Textures, LeaveAFurnaceWhite) {
  const ScratchFolder folder;
  put_png(folder.file("rough.png"), 64, 32, [](int x, int y) { return Bytes{x * 4, y * 8, 100}; });
  put_exr(folder.file("white.exr"), 64, 32, [](int x, int y) {
    const double v = (x + y) % 2 == 0 ? 1 : .9999999;
    return std::array<double, 3>{v, v, v};
  });
  std::string text = ball_scene("", .05, "lambert");
  const std::size_t begin = text.find("\"sigma_a\""), end = text.find("}", begin);
  text.replace(
      begin, end - begin,
      R"("subsurface_radius": 0.05, "subsurface_color": {"texture": "white.exr"}, "specular_ior": 1.4)");
  const std::vector<std::string> fine{"settings.light_samples=1024"};
  const Image image = picture_of(folder, text, fine);
  for (int y = 0; y < 33; ++y)
    for (int x = 0; x < 33; ++x)
      for (const char* name : {"R", "G", "B"})
        EXPECT_NEAR(channel(image, x, y, name), 1, .005) << x << ' ' << y;
  text.insert(text.find("\"specular_ior\""),
              R"("specular_roughness": {"texture": "rough.png", "channel": "g"}, )");
  const Image rough = picture_of(folder, text, {fine.front(), "film.samples_per_pixel=4"});
  double sum = 0;
  for (int y = 0; y < 33; ++y)
    for (int x = 0; x < 33; ++x) sum += channel(rough, x, y, "G") / (33 * 33);
  EXPECT_NEAR(sum, 1, .01);
}

// Claim: an edited texture makes a session compute what depends on it and nothing else, and its picture is that of a new
// one; a scene that comes back finds the same bits. Fails if keys lack the file's contents, or samples and light are
// thrown away with the colour.
TEST(Textures, AreEditedInASession) {
  const ScratchFolder folder;
  const auto put = [&](int value) {
    put_png(folder.file("paint.png"), 8, 8, [&](int x, int) { return Bytes{x < 4 ? value : 250, 200, 200}; });
    std::filesystem::last_write_time(folder.file("paint.png"),
                                     std::filesystem::file_time_type() + std::chrono::hours(value));
  };
  const std::string text = ball_scene(R"("tint": {"texture": "paint.png"})", .5);
  const auto scene = [&] { return with_few_triangles(parse_scene(text, folder.file("scene.json"))); };
  Session session;
  put(100);
  session.edit(scene());
  const Image first = session.render().image;
  put(200);
  session.edit(scene());
  const Image second = session.render().image;
  EXPECT_FALSE(same_pixels(first, second));
  EXPECT_EQ(session.work().samples_placed + session.work().lights_traced + session.work().meshes_read, 0u);
  EXPECT_GT(session.work().nodes_built, 0u);
  EXPECT_TRUE(same_pixels(second, picture_of(folder, text)));
  session.edit(scene());
  session.render();
  EXPECT_EQ(session.work().nodes_built, 0u);
}

// Claim: a metal in an even room is as bright as its colour in the mirror, smooth or little rough, and a glossy dielectric
// of reflectance 1 as bright as the room. Tolerance: .01, facets that reflect twice are lost. Fails if a metal is coated
// with its dielectric as well, or the colour is left out.
TEST(Textures, MetalsMirrorInTheirColour) {
  const ScratchFolder folder;
  const auto seen = [&](const std::string& surface) {
    std::string text = quad_scene(surface);
    text.insert(1, "\"surroundings\": 1, ");
    const std::size_t lights = text.find("\"lights\""), camera = text.find("\"camera\"");
    text.erase(lights, camera - lights);
    return picture_of(folder, text);
  };
  const auto mean = [](const Image& image, const char* name) {
    double sum = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) sum += channel(image, x, y, name) / 256;
    return sum;
  };
  for (const std::string roughness : {"0", "0.2"}) {
    const Image metal =
        seen(R"("reflectance": [0.9, 0.5, 0.2], "metalness": 1, "specular_roughness": )" + roughness);
    EXPECT_NEAR(mean(metal, "R"), .9, .01) << roughness;
    EXPECT_NEAR(mean(metal, "B"), .2, .01) << roughness;
    const Image glossy = seen(R"("reflectance": 1, "specular_roughness": )" + roughness);
    EXPECT_NEAR(mean(glossy, "G"), 1, .01) << roughness;
    EXPECT_GT(channel(glossy, 8, 8, "specular.G"), .03) << roughness;
  }
  put_png(folder.file("metal.png"), 64, 64, [](int x, int) { return Bytes{x < 32 ? 255 : 0, 0, 0}; });
  const Image half = seen(
      R"("reflectance": [0.9, 0.5, 0.2], "metalness": {"texture": "metal.png"}, "specular_roughness": 0)");
  EXPECT_NEAR(channel(half, 3, 8, "diffuse.R"), 0, 1e-3);
  EXPECT_GT(channel(half, 12, 8, "diffuse.R"), .5);
}

}  // namespace
}  // namespace opaline::test
