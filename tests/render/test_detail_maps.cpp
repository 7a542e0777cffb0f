// SPDX-License-Identifier: GPL-3.0-or-later
// Textures with finer textures over them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

Image sheet(const ScratchFolder& folder, const std::string& look) {
  return picture_of(
      folder,
      R"({"shapes": [{"quad": {"corner": [-10, -10, 0], "u": [20, 0, 0], "v": [0, 20, 0]}, )" + look + R"(}],
    "lights": [{"type": "point", "position": [6, 10, 30], "intensity": 1000}],
    "camera": {"position": [0, 0, 60], "look_at": [0, 0, 0], "field_of_view": 18},
    "settings": {"bounces": 0, "method": "lambert"}, "film": {"pixel_type": "float", "resolution": [16, 16]}})");
}

void put_even(const std::string& path, const std::array<double, 3>& texel) {
  put_exr(path, 4, 4, [&](int, int) { return texel; });
}

// Claim: a detail multiplies a colour by its texels over their mean, several multiply each other, and the result ends at 1. Source: by hand.
// Tolerance: .2 %, the halves of the files. Fails if: a detail is not relative, a constant base forgets it, or the base is clamped first.
TEST(DetailMaps, MultiplyColors) {
  const ScratchFolder folder;
  put_even(folder.file("base.exr"), {.4, .4, .8});
  put_exr(folder.file("halves.exr"), 64, 64, [](int x, int) {
    return x < 32 ? std::array<double, 3>{.1, .3, .1} : std::array<double, 3>{.3, .1, .3};
  });
  const std::string detail = R"({"texture": "halves.exr"})";
  const auto look = [&](const std::string& details) {
    return sheet(folder, R"("reflectance": {"texture": "base.exr", "detail": [)" + details + "]}");
  };
  const Image none = look(""), one = look(detail), two = look(detail + ", " + detail);
  for (const int x : {4, 12}) {
    SCOPED_TRACE(x);
    const std::array<float, 3> factor =
        x < 8 ? std::array<float, 3>{.5f, 1.5f, .5f} : std::array<float, 3>{1.5f, .5f, 1.5f};
    const std::array<float, 3> base{.4f, .4f, .8f};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::string layer = std::string("albedo.") + "RGB"[c];
      EXPECT_NEAR(channel(none, x, 8, layer), base[c], .002f * base[c]);
      EXPECT_NEAR(channel(one, x, 8, layer), std::min(1.f, base[c] * factor[c]), .002f);
      EXPECT_NEAR(channel(two, x, 8, layer), std::min(1.f, base[c] * factor[c] * factor[c]), .003f);
    }
  }
}

// Claim: an overlay combines a base s and a detail d by 2 s d below s = .5, and above by 1 - 2 (1 - s) (1 - d) for d of at least .5, and
// by the mean of 2 s d and s, weighted by (2 s - 1)^2, for smaller d. The neutral bytes 127 and 128 have no effect; `scale` follows, and relative
// details. Source: an independent computation of the rows. Tolerance: .2 %, the halves of the files. Fails if: the plain overlay is
// used (.625, .82), the detail counts as sRGB, or the base is scaled first.
TEST(DetailMaps, Overlay) {
  const ScratchFolder folder;
  const auto albedo = [&](double base, const std::string& detail, const std::string& more = "") {
    put_even(folder.file("base.exr"), {base, base, .2});
    return channel(
        sheet(folder,
              R"("reflectance": {"texture": "base.exr", "detail": [{"blend": "overlay", "texture": ")" +
                  detail + R"("})" + more),
        12, 8, "albedo.G");
  };
  const auto even = [&](double value) {
    put_even(folder.file("detail.exr"), {value, value, .2});
    return std::string("detail.exr");
  };
  EXPECT_NEAR(albedo(.75, even(.25), "]}"), .46875, .001);
  EXPECT_NEAR(albedo(.9, even(.1), "]}"), .6408, .0013);
  EXPECT_NEAR(albedo(.75, even(.75), "]}"), .875, .0018);
  EXPECT_NEAR(albedo(.25, even(.75), "]}"), .375, .0008);
  EXPECT_NEAR(albedo(.75, even(.25), R"(], "scale": 0.5})"), .234375, .0005);
  put_exr(folder.file("halves.exr"), 64, 64, [](int x, int) {
    return x < 32 ? std::array{.1, .1, .1} : std::array{.3, .3, .3};
  });
  EXPECT_NEAR(albedo(.75, even(.25), R"(, {"texture": "halves.exr"}]})"), 1.5 * .46875, .0015);
  for (const auto byte : {std::uint8_t(127), std::uint8_t(128)}) {
    put_png(folder.file("neutral.png"), 4, 4, {byte, byte, byte});
    EXPECT_EQ(albedo(.75, "neutral.png", "]}"), .75f) << int(byte);
  }
  put_png(folder.file("dark.png"), 4, 4, {51, 51, 51});
  EXPECT_NEAR(albedo(.25, "dark.png", "]}"), .1, .0005);
}

// Claim: the mean of a medium's colour is that of its texture without an overlay, and each texel its overlaid colour. Source: by hand: overlaid
// .46875 over .75. Tolerance: .3 %. Fails if: the overlay is applied to the texel over the mean (1).
TEST(DetailMaps, OverlayOfMedia) {
  const ScratchFolder folder;
  put_even(folder.file("detail.exr"), {.25, .25, .25});
  put_exr(folder.file("base.exr"), 8, 8, [](int x, int) { return std::array{.75, .75, .5 + .001 * x}; });
  const auto green = [&](const std::string& detail) {
    return channel(
        picture_of(folder, R"({"media": {"m": {"subsurface_color": {"texture": "base.exr")" + detail +
                               R"(}, "subsurface_radius": 0.01, "texture_mix": "post"}},
    "shapes": [{"box": {"low": [-10, -10, -5], "high": [10, 10, 0]}, "medium": "m"}],
    "lights": [{"type": "point", "position": [6, 10, 30], "intensity": 1000}],
    "camera": {"position": [0, 0, 60], "field_of_view": 10},
    "settings": {"method": "lambert"}, "film": {"pixel_type": "float", "resolution": [4, 4]}})"),
        2, 2, "diffuse.G");
  };
  const double ratio =
      double(green(R"(, "detail": [{"blend": "overlay", "texture": "detail.exr"}])") / green(""));
  EXPECT_NEAR(ratio, .46875 / .75, .003);
}

// Claim: a detail of a normal map tilts its normal further. Source: reoriented normal mapping (Barre-Brisebois & Hill 2012) of (.3, .1, .9) and
// (-.2, .4, .8), both normalised: (.05998917, .52917147, .84639167); turned frames keep its tilt and twist it by .5 degrees. Tolerance: .7
// degrees (adding slopes: .86; two steps in one frame: 2.5). Fails if: the detail's frame is the mesh's, or it replaces the normal.
TEST(DetailMaps, TurnNormals) {
  const ScratchFolder folder;
  const auto put_normal = [&](const std::string& name, const Vec3d& direction) {
    const Vec3d n = normalized(direction);
    put_even(folder.file(name), {.5 + .5 * n.x, .5 + .5 * n.y, .5 + .5 * n.z});
  };
  put_normal("base.exr", {.3, .1, .9});
  put_normal("detail.exr", {-.2, .4, .8});
  const auto normal_of = [&](const std::string& details) {
    const Image image = sheet(
        folder, R"("reflectance": 0.5, "normal_map": {"texture": "base.exr", "detail": [)" + details + "]}");
    return Vec3d{channel(image, 8, 8, "N.X"), channel(image, 8, 8, "N.Y"), channel(image, 8, 8, "N.Z")};
  };
  const auto degrees = [](const Vec3d& a, const Vec3d& b) {
    return std::acos(std::min(1., dot(a, b))) * 180 / kPi;
  };
  EXPECT_LT(degrees(normal_of(""), normalized(Vec3d{.3, .1, .9})), .1);
  EXPECT_LT(degrees(normal_of(R"({"texture": "detail.exr"})"), {.05998917, .52917147, .84639167}), .7);
}

}  // namespace
}  // namespace opaline::test
