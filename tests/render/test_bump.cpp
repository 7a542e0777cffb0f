// SPDX-License-Identifier: GPL-3.0-or-later
// Normals that heights turn, against meshes that have the heights.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/scratch_folder.h"
#include "input/load_scene.h"
#include "session/session_records.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"
#include "transport/fresnel.h"

namespace opaline::test {
namespace {

constexpr int kPixels = 128, kTexels = 256, kCells = 512;
constexpr double kHeight = .05;  // of waves, scene units, two sides of 2

// Of the unit square, v upwards: [0, kHeight].
double height(double u, double v) {
  return kHeight * (.5 + .25 * std::sin(4 * kPi * u) + .25 * std::cos(2 * kPi * (v + u)));
}

void put_heights(const std::string& path, int texels = kTexels) {
  put_exr(path, texels, texels, [&](int x, int y) {
    const double h = height((x + .5) / texels, 1 - (y + .5) / texels) / kHeight;
    return std::array<double, 3>{h, h, h};
  });
}

/// A grid over the square from -1 to 1, moved by the heights, with normals of the exact surface.
std::string displaced_grid() {
  std::string text;
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) {
      const double u = double(i) / kCells, v = double(j) / kCells, e = 1e-5;
      const double of_u = (height(u + e, v) - height(u - e, v)) / (4 * e),
                   of_v = (height(u, v + e) - height(u, v - e)) / (4 * e);
      text += fmt::format("v {} {} {}\nvn {} {} 1\n", 2 * u - 1, 2 * v - 1, height(u, v), -of_u, -of_v);
    }
  const auto corner = [](int i, int j) {
    const int index = j * (kCells + 1) + i + 1;
    return fmt::format(" {}//{}", index, index);
  };
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i)
      text += "f" + corner(i, j) + corner(i + 1, j) + corner(i + 1, j + 1) + corner(i, j + 1) + '\n';
  return text;
}

/// The picture of one shape that fills it, seen from the front or from behind.
Image bumped_picture(const ScratchFolder& folder, const std::string& shape, bool from_behind = false,
                     const std::string& unit = "1") {
  Session session;
  const double z = from_behind ? -200 : 200;
  session.edit(parse_scene(R"({"mm_per_unit": )" + unit + R"(, "shapes": [{)" + shape +
                               R"(}], "lights": [{"type": "directional", "direction": [-1, -0.5, )" +
                               (from_behind ? "1" : "-1") + R"(], "irradiance": 3}],
         "camera": {"position": [0, 0, )" +
                               std::to_string(z) + R"(], "field_of_view": 0.53}, "film": {"resolution": [)" +
                               std::to_string(kPixels) + ", " + std::to_string(kPixels) +
                               R"(], "pixel_type": "float"}})",
                           folder.file("scene.json"), {}));
  return session.render().image;
}

const std::string kQuad = R"("quad": {"corner": [-1, -1, 0], "u": [2, 0, 0], "v": [0, 2, 0]})";

std::string bump(const std::string& keys) {
  return R"(, "bump_map": {"texture": "h.exr")" + keys + "}";
}

Vec3d normal_at(const Image& image, int x, int y) {
  return {channel(image, x, y, "N.X"), channel(image, x, y, "N.Y"), channel(image, x, y, "N.Z")};
}

/// Degrees between normals: the mean and the largest.
std::pair<double, double> angles(const Image& a, const Image& b) {
  double sum = 0, largest = 0;
  for (int y = 0; y < kPixels; ++y)
    for (int x = 0; x < kPixels; ++x) {
      const Vec3d n = normal_at(a, x, y), m = normal_at(b, x, y);
      const double angle = std::atan2(length(cross(n, m)), dot(n, m)) * 180 / kPi;
      sum += angle / (kPixels * kPixels);
      largest = std::max(largest, angle);
    }
  return {sum, largest};
}

// Claim: normals under a bump map are those of the mesh that has its heights, from the front and from behind, however the
// picture is laid, and in other units; they are up to 9 degrees from flat. Source: the mesh's exact normals. Tolerance: .03
// degree in the mean, .12 at most, of which the filter has most: it takes 3 % of waves of 20 texels of the size looked up. Fails if a
// gradient's axis is exchanged or turned round, the slope is per texel, or heights are not in scene units.
TEST(BumpMap, TurnsNormalsAsHeightsDo) {
  const ScratchFolder folder;
  put_heights(folder.file("h.exr"));
  put_bytes(folder.file("grid.obj"), displaced_grid());
  const std::string scale = R"(, "scale": 0.05)";
  for (const bool from_behind : {false, true}) {
    const Image grid = bumped_picture(folder, R"("file": "grid.obj")", from_behind);
    const auto expect = [&](const Image& bumped) {
      const auto [mean, largest] = angles(bumped, grid);
      EXPECT_LT(mean, .03) << from_behind;
      EXPECT_LT(largest, .12) << from_behind;
    };
    EXPECT_GT(angles(bumped_picture(folder, kQuad, from_behind), grid).first, 3);
    expect(bumped_picture(folder, kQuad + bump(scale), from_behind));
    expect(bumped_picture(folder, kQuad + bump(scale), from_behind, "40"));
    // The quad's u goes up and its v to the left: the picture is turned back.
    expect(bumped_picture(folder,
                          R"("quad": {"corner": [1, -1, 0], "u": [0, 2, 0], "v": [-2, 0, 0]})" +
                              bump(scale + R"(, "uv_rotation": 90, "uv_offset": [0, 1])"),
                          from_behind));
  }
}

// Claim: heights that are alike change no bit, a hundred times as fine as the pixels they are flat, and a map of normals
// that says the slopes of the same heights is the same surface. Tolerance: of fine ones 1 degree, 8 % of what each texel
// leans. Fails if constants are looked up, or slopes have no footprint.
TEST(BumpMap, OfNoHeightIsNone) {
  const ScratchFolder folder;
  put_png(folder.file("h.exr.png"), 4, 4, Bytes{128, 128, 128});
  const Image flat = bumped_picture(folder, kQuad);
  const Image constant = bumped_picture(folder, kQuad + R"(, "bump_map": {"texture": "h.exr.png"})");
  EXPECT_EQ(flat.pixels, constant.pixels);
  put_exr(folder.file("h.exr"), 2048, 2048, [](int x, int y) {
    const double h = (x / 4 + y / 4) % 2;
    return std::array<double, 3>{h, h, h};
  });
  EXPECT_LT(angles(bumped_picture(folder, kQuad + bump(R"(, "scale": 0.001)")), flat).second, 1);
}

// Claim: a map without relief changes nothing, beside shadow edges and under lights with an area too. Source: by hand. Tolerance: 1e-5,
// rounding of the factor. Fails if: the near field of bodies with maps has no light of its own, by lattice or by drawn points.
TEST(BumpMap, FlatOnesChangeNothing) {
  const ScratchFolder folder;
  put_exr(folder.file("flat.exr"), 4, 4, [](int, int) { return std::array{.5, .5, .5}; });
  for (const std::string size : {"48", "6"}) {
    const auto picture = [&](const std::string& map) {
      return picture_of(folder,
                        R"({"media": {"m": {"sigma_a": 0.01, "sigma_s_prime": 10, "specular_ior": 1.3}},
          "shapes": [{"box": {"low": [-10, -10, -6], "high": [10, 10, 0]}, "medium": "m")" +
                            map +
                            R"(}, {"box": {"low": [-1, -20, 3], "high": [1, 20, 4]}}],
          "lights": [{"type": "sphere", "center": [5, 0, 20], "radius": 1, "radiance": 100}],
          "camera": {"position": [0, 0, 100], "field_of_view": 9}, "film": {"pixel_type": "float", "resolution": [)" +
                            size + "," + size + R"(]},
          "settings": {"bounces": 0, "samples": 800, "method": "hierarchical", "evaluator": "dual_tree"}})");
    };
    const Image plain = picture(""), flat = picture(R"(, "bump_map": {"texture": "flat.exr"})");
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
      ASSERT_NEAR(flat.pixels[i], plain.pixels[i], 1e-5f * std::abs(plain.pixels[i]) + 1e-9f)
          << size << ' ' << i;
  }
}

// Claim: light enters a body by the normals of its maps: tilted by 20 degrees towards or away from a lamp at 60 degrees, the body is brighter or
// darker as the cosine and Fresnel's transmittance, and the factor of tilted parts, whatever the method. Source: by hand. Tolerance: 5 %:
// hits have no such factor (3 %), and volume methods are noisy. Fails if: a method's samples, entries or walks ignore maps (53 and 65 %).
TEST(BumpMap, LightEntersByItsNormals) {
  const ScratchFolder folder;
  const double tilt = 20 * kPi / 180, sine = std::sin(tilt) / 2, cosine = std::cos(tilt) / 2;
  put_exr(folder.file("right.exr"), 4, 4, [&](int, int) { return std::array{.5 + sine, .5, .5 + cosine}; });
  put_exr(folder.file("left.exr"), 4, 4, [&](int, int) { return std::array{.5 - sine, .5, .5 + cosine}; });
  const auto brightness = [&](const std::string& method, const std::string& map) {
    const Image image = picture_of(
        folder,
        R"({"media": {"m": {"sigma_a": 0.3, "sigma_s_prime": 3, "specular_ior": 1.3}},
            "shapes": [{"box": {"low": [-10, -10, -6], "high": [10, 10, 0]}, "medium": "m")" +
            map +
            R"(}], "lights": [{"type": "directional", "direction": [-0.8660254, 0, -0.5], "irradiance": 3}],
            "camera": {"position": [0, 0, 100], "field_of_view": 4}, "film": {"resolution": [8, 8], "pixel_type": "float"},
            "settings": {"bounces": 0, "samples": 1200, "cell_size": 4, "entry_samples": 64, "method": ")" +
            method + R"("}})");
    double sum = 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) sum += double(channel(image, x, y, "diffuse.G"));
    return sum;
  };
  const auto entering = [](double degrees) {
    const double c = std::cos(degrees * kPi / 180);
    return c * double(fresnel_transmittance(float(c), 1.3f));
  };
  const double factor = 1 / std::sqrt(std::cos(tilt));
  for (const std::string method : {"hierarchical", "direct", "volume_diffusion", "volume", "image_space"}) {
    SCOPED_TRACE(method);
    const double flat = brightness(method, "");
    EXPECT_NEAR(brightness(method, R"(, "normal_map": {"texture": "right.exr"})") / flat,
                factor * entering(40) / entering(60), .05 * 1.6);
    EXPECT_NEAR(brightness(method, R"(, "normal_map": {"texture": "left.exr"})") / flat,
                factor * entering(80) / entering(60), .05);
  }
}

// Claim: what sends back all light is as bright as an even room under bumps that lean by 10 degrees: matte, coated and
// translucent. Source: conservation. Tolerance: 1 % of the mean; of a pixel that of the same ball without bumps and 2 %
// more, 4 % with the noise of facets. Fails if what is mirrored into the surface is lost, or sees it from inside (70 % of a pixel).
TEST(BumpMap, LeavesAFurnaceWhite) {
  const ScratchFolder folder;
  put_heights(folder.file("h.exr"));
  const auto ball = [&](const std::string& surface, const std::string& map) {
    Session session;
    session.edit(parse_scene(R"({"media": {"m": {"sigma_a": 0, "sigma_s_prime": 40, "specular_ior": 1.4}},
        "shapes": [{"sphere": {"radius": 10}, )" +
                                 surface + map + R"(}], "surroundings": 1,
        "camera": {"position": [0, 0, 60], "field_of_view": 16}, "film": {"resolution": [24, 24]},
        "settings": {"method": "lambert", "light_samples": 1024}})",
                             folder.file("scene.json"), {}));
    return session.render().image;
  };
  for (const std::string surface : {R"("reflectance": 1)", R"("reflectance": 1, "specular_roughness": 0)",
                                    R"("reflectance": 1, "specular_roughness": 0.3)", R"("medium": "m")"}) {
    const Image plain = ball(surface, ""), bumped = ball(surface, bump(R"(, "scale": 2)"));
    const double tolerance = surface.find("roughness\": 0.3") == surface.npos ? .02 : .04;
    SCOPED_TRACE(surface);
    double sum = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        sum += channel(bumped, x, y, "G") / (24 * 24);
        EXPECT_NEAR(channel(bumped, x, y, "G"), channel(plain, x, y, "G"), tolerance) << x << ' ' << y;
      }
    EXPECT_NEAR(sum, 1, .01) << surface;
  }
}

// Claim: highlights of small, bright lights on steep bumps have no specks, and one mean for lights of one power and of any
// small size, also a point: light that a bent normal reflects into the surface and from there outwards is sampled by the
// lights, too. Source: Veach & Guibas 1995, the weights; bench: brightest pixel over the 99.9th percentile 8.8 without them,
// 1.5 with. Tolerance: 3 times; 2 % of the mean, against 6 % where small lights lack this light. Fails if: lights met by such
// rays have the weight 1, or these rays alone bring the light.
TEST(BumpMap, SmallLightsLeaveNoSpecks) {
  const ScratchFolder folder;
  const auto specular = [&](const std::string& light) {
    const Image image =
        picture_of(folder, R"({"media": {"m": {"sigma_a": 0.1, "sigma_s_prime": 1, "specular_ior": 1.4,
        "specular_roughness": 0.4}},
      "shapes": [{"sphere": {"radius": 50}, "medium": "m",
        "bump_map": {"noise": "clouds", "size": 2, "octaves": 4, "scale": 0.8}}],
      "lights": [{"name": "sun", )" +
                               light +
                               R"(}], "camera": {"position": [0, 0, 300], "field_of_view": 21},
      "film": {"resolution": [96, 96], "samples_per_pixel": 16}, "settings": {"method": "lambert", "bounces": 0}})");
    std::vector<double> values;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 96; ++x)
        if (channel(image, x, y, "A") > 0) values.push_back(double(channel(image, x, y, "specular.R")));
    std::ranges::sort(values);
    return values;
  };
  const auto mean = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.) / double(values.size());
  };
  const std::vector<double>
      wide = specular(R"("type": "sphere", "center": [400, 200, 100], "radius": 30, "radiance": 1111.11)"),
      small = specular(R"("type": "sphere", "center": [400, 200, 100], "radius": 3, "radiance": 111111)"),
      point = specular(R"("type": "point", "position": [400, 200, 100], "intensity": 3.14159e6)");
  EXPECT_LT(wide.back(), 3 * wide[wide.size() * 999 / 1000]);
  EXPECT_NEAR(mean(small), mean(wide), .02 * mean(wide));
  EXPECT_NEAR(mean(point), mean(wide), .02 * mean(wide));
}

}  // namespace
}  // namespace opaline::test
