// SPDX-License-Identifier: GPL-3.0-or-later
// Colours at the vertices of meshes, as images show them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

constexpr const char* kRed = " .8 .2 .1 1";
constexpr const char* kBlue = " .1 .3 .9 1";

/// A square from -1 to 1 whose left half is red and whose right half is blue.
const std::string kHalves = [] {
  std::string text = "COFF 8 2 0\n";
  for (const auto& [x, color] : {std::pair{-1, kRed}, {0, kBlue}})
    for (const auto& [u, v] : {std::pair{0, -1}, {1, -1}, {1, 1}, {0, 1}})
      text += std::to_string(x + u) + ' ' + std::to_string(v) + " 0" + color + '\n';
  return text + "4 0 1 2 3\n4 4 5 6 7\n";
}();

/// A cube of side 10 whose middle is at this x.
std::string cube_off(double x, const std::string& color) {
  std::string text = color.empty() ? "OFF 8 6 0\n" : "COFF 8 6 0\n";
  for (int i = 0; i < 8; ++i)
    text +=
        std::to_string(x + (i & 1 ? 5 : -5)) + (i & 2 ? " 5" : " -5") + (i & 4 ? " 5" : " -5") + color + '\n';
  return text + "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
}

struct ColorFolder : ScratchFolder {
  ColorFolder() {
    put_bytes(file("halves.off"), kHalves);
    put_bytes(file("plain.off"), cube_off(0, ""));
    put_bytes(file("red.off"), cube_off(0, kRed));
    put_bytes(file("left.off"), cube_off(-8, ""));
    put_bytes(file("right.off"), cube_off(8, kRed));
    put_png(file("two.png"), 4, 4, [](int x, int) {
      return x < 2 ? Bytes{188, 188, 188} : Bytes{99, 99, 99};
    });
    put_bytes(
        file("uv.ply"),
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property float u\nproperty float v\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "-9 -9 0 0.1 0 255 0 0\n9 -9 0 0.2 0 255 0 0\n0 9 0 0.2 0.3 255 0 0\n3 0 1 2\n");
  }
};

std::string flat_scene(const std::string& shape) {
  return R"({"shapes": [{)" + shape + R"(}],
    "lights": [{"type": "directional", "direction": [0, 0, -1], "irradiance": 3}],
    "camera": {"position": [0, 0, 10], "field_of_view": 11.3}, "film": {"resolution": [16, 16], "pixel_type": "float"}})";
}

const std::string kQuad = R"("quad": {"corner": [-1, -1, 0], "u": [2, 0, 0], "v": [0, 2, 0]}, )";

// Claim: vertex colours are the reflectance of an opaque surface, or multiply one that the scene gives; of a metal as well.
// Tolerance: float rounding. Fails if colours are passed over, or the default of 0.5 darkens them.
TEST(VertexColors, AreReflectance) {
  const ColorFolder folder;
  const struct {
    std::string keys, rest;  // of the coloured surface, and of both
    double factor;
  } cases[] = {{"", "", 1},
               {R"(, "reflectance": 0.5)", "", .5},
               {R"(, "reflectance": 1)", R"(, "metalness": 1, "specular_roughness": 0.5)", 1}};
  for (const auto& c : cases) {
    const auto plain = [&](const Rgb& color) {
      const Rgb scaled = color * c.factor;
      return picture_of(
          folder, flat_scene(kQuad + "\"reflectance\": [" + std::to_string(scaled.x) + ", " +
                             std::to_string(scaled.y) + ", " + std::to_string(scaled.z) + "]" + c.rest));
    };
    const Image both = picture_of(folder, flat_scene(R"("file": "halves.off")" + c.keys + c.rest)),
                red = plain({.8, .2, .1}), blue = plain({.1, .3, .9});
    for (int x = 1; x < 15; ++x)
      for (const char* name : {"R", "G", "B", "albedo.R", "albedo.B"}) {
        const double expected = channel(x < 8 ? red : blue, x, 8, name);
        EXPECT_NEAR(channel(both, x, 8, name), expected, 1e-5 * expected) << c.keys << c.rest << x << name;
      }
  }
}

// Claim: under a texture vertex colours are left out, with a warning of the plan, unless the scene asks for both.
// Tolerance: halves of the texture cache. Fails if a scan's colours are multiplied by its own texture.
TEST(VertexColors, StandBackForTextures) {
  const ColorFolder folder;
  const auto render_of = [&](const std::string& keys) {
    Session session;
    session.edit(parse_scene(flat_scene(R"("file": "uv.ply", "reflectance": {"texture": "two.png"})" + keys),
                             folder.file("scene.json"), {}));
    session.prepare();
    const double green = channel(session.render().image, 8, 8, "G");
    const bool warns = std::ranges::any_of(session.plan().warnings, [](const std::string& text) {
      return text.find("a texture replaces the vertex colours") != text.npos;
    });
    return std::pair{warns, green};
  };
  const auto [warned, green] = render_of("");
  EXPECT_TRUE(warned);
  EXPECT_GT(green, .3);
  for (const auto& [keys, expected] :
       {std::pair{R"(, "vertex_colors": true)", 0.}, {R"(, "vertex_colors": false)", green}}) {
    const auto [warns, seen] = render_of(keys);
    EXPECT_FALSE(warns) << keys;
    EXPECT_EQ(seen, expected) << keys;
  }
}

// Claim: vertex colours multiply a medium's tint, whichever method computes the light inside and wherever the tint is met:
// a body of one colour is that of a constant tint. A partly opaque body's base colour is multiplied, too. Tolerance: float
// rounding, which moves random walks' clamps by less. Fails if a way of light into or out of the body lacks the factor.
TEST(VertexColors, MultiplyTheTint) {
  const ColorFolder folder;
  const auto scene = [](const std::string& shapes, const std::string& medium, const std::string& method) {
    return R"({"media": {"m": {"sigma_a": 0.02, "sigma_s_prime": 1, "specular_ior": 1.4)" + medium + R"(}},
      "shapes": [)" +
           shapes + R"(], "surroundings": 1,
      "camera": {"position": [0, 20, 60], "look_at": [0, 0, 0], "field_of_view": 24},
      "film": {"resolution": [12, 8], "pixel_type": "float"},
      "settings": {"samples": 500, "light_samples": 4, "entry_samples": 8, "method": ")" +
           method + R"("}})";
  };
  const std::string red = R"({"file": "red.off", "medium": "m"})",
                    plain = R"({"file": "plain.off", "medium": "m"})";
  const std::string tint = R"(, "tint": [0.8, 0.2, 0.1])";
  const auto expect_same = [&](const Image& a, const Image& b, const std::string& what) {
    double light = 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 12; ++x)
        for (const char* name : {"R", "G", "B"}) {
          light += channel(b, x, y, name);
          EXPECT_NEAR(channel(a, x, y, name), channel(b, x, y, name), 1e-4)
              << what << ' ' << x << ' ' << y << name;
        }
    EXPECT_GT(light, 1) << what;
  };
  for (const char* method : {"lambert", "hierarchical", "direct", "volume_diffusion", "volume"})
    for (const std::string mix : {"pre", "split", "post"}) {
      const std::string keys = R"(, "texture_mix": ")" + mix + '"';
      expect_same(picture_of(folder, scene(red, keys, method)),
                  picture_of(folder, scene(plain, keys + tint, method)), method + mix);
    }
  const std::string half = R"(, "subsurface_weight": 0.5)";
  expect_same(
      picture_of(folder, scene(red, half + R"(, "base_color": 0.5)", "hierarchical")),
      picture_of(folder, scene(plain, half + tint + R"(, "base_color": [0.4, 0.1, 0.05])", "hierarchical")),
      "partly opaque");
  // Of two shapes of one body the second has colours: its light is coloured as it enters.
  const auto pair = [](const std::string& keys) {
    return R"({"file": "left.off", "medium": "m", "group": "g"}, {"file": "right.off", "medium": "m", "group": "g")" +
           keys + "}";
  };
  const std::string pre = R"(, "texture_mix": "pre")";
  const Image coloured = picture_of(folder, scene(pair(""), pre, "hierarchical")),
              white = picture_of(folder, scene(pair(R"(, "vertex_colors": false)"), pre, "hierarchical"));
  EXPECT_LT(channel(coloured, 9, 4, "B"), .3 * channel(white, 9, 4, "B"));
  EXPECT_GT(channel(coloured, 3, 4, "B"), .7 * channel(white, 3, 4, "B"));
}

// Claim: an edit of colours is noticed by a session. Source: Session. Fails if a key lacks them.
TEST(VertexColors, AreInKeys) {
  const ColorFolder folder;
  const auto scene_with = [&](const std::string& colors) {
    return parse_scene(
        R"({"media": {"m": {"preset": "marble"}}, "shapes": [{"name": "a", "file": "red.off", "medium": "m",
      "vertex_colors": )" +
            colors + R"(}, {"quad": {"corner": [-40, -6, 40], "u": [80, 0, 0], "v": [0, 0, -80]}}],
      "surroundings": 1, "camera": {"position": [0, 20, 60], "look_at": [0, 0, 0]}, "film": {"resolution": [12, 8]},
      "settings": {"samples": 300, "light_samples": 4}})",
        folder.file("scene.json"), {});
  };
  Session session;
  session.hold_view(true);
  session.match_new_session(true);
  const Image red = picture_of(session, scene_with("true"));
  EXPECT_FALSE(same_pixels(picture_of(session, scene_with("false")), red));
  EXPECT_TRUE(same_pixels(picture_of(session, scene_with("true")), red));
  put_bytes(folder.file("red.off"), cube_off(0, kBlue));
  const Image blue = picture_of(session, scene_with("true"));
  EXPECT_FALSE(same_pixels(blue, red));
  EXPECT_TRUE(same_pixels(blue, cold_picture(scene_with("true"))));
}

}  // namespace
}  // namespace opaline::test
