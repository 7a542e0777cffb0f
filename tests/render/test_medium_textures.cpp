// SPDX-License-Identifier: GPL-3.0-or-later
// Textures of a medium's colour and radius that hold inside a body.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scratch_folder.h"
#include "geometry/nearest_surface.h"
#include "support/cell_exitance.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/surfaces.h"
#include "volume/nearest_sample.h"

namespace opaline::test {
namespace {

/// A ball of wax, lit from above.
std::string wax_scene(const std::string& color, const std::string& radius, const std::string& settings,
                      const std::string& medium = "") {
  return R"({"media": {"wax": {"specular_ior": 1.4, "subsurface_color": )" + color +
         R"(, "subsurface_radius": )" + radius + medium + R"(}},
         "shapes": [{"name": "ball", "sphere": {"radius": 6}, "medium": "wax"}],
         "lights": [{"type": "directional", "direction": [-0.1, -1, -0.4], "irradiance": 2}],
         "camera": {"position": [0, 0, 40], "field_of_view": 20}, "film": {"resolution": [24, 24]},
         "settings": {)" +
         settings + "}}";
}

const std::vector<std::string> kMethodsInside{
    R"("method": "hierarchical", "samples": 3000)", R"("method": "direct", "entry_samples": 4)",
    R"("method": "volume_diffusion")", R"("method": "volume", "samples": 50, "until_error": 0.5)"};

// Claim: textures whose texels are alike are the constants, to the last bit, by every method. Fails if: they are looked up.
TEST(MediumTextures, OfOneTexelAreConstants) {
  const ScratchFolder folder;
  put_png(folder.file("grey.png"), 4, 4, Bytes{204, 204, 204});
  const std::string texture = R"({"texture": "grey.png", "color_space": "linear"})";
  for (const std::string& method : kMethodsInside)
    EXPECT_TRUE(
        same_pixels(picture_of(folder, wax_scene(texture, texture, method, R"(, "texture_mix": "medium")")),
                    picture_of(folder, wax_scene("0.8", "0.8", method))))
        << method;
}

// Claim: methods that have one medium throughout take the mean radius, and a colour of the medium as "split" does. Source:
// the same scenes so. Tolerance: none. Fails if: such a texture is passed over, or met by light that is not followed inside.
TEST(MediumTextures, OfRadialProfilesAreMeans) {
  const ScratchFolder folder;
  put_png(folder.file("two.png"), 8, 8, [](int x, int) {
    return x < 4 ? Bytes{200, 160, 120} : Bytes{100, 220, 180};
  });
  const std::string color = R"({"texture": "two.png"})";
  for (std::size_t m = 0; m < 2; ++m) {
    const auto picture = [&](const std::string& radius, const std::string& mix) {
      return picture_of(folder,
                        wax_scene(color, radius, kMethodsInside[m], ", \"texture_mix\": \"" + mix + '"'));
    };
    const Image inside = picture(R"({"texture": "two.png", "scale": 2})", "medium");
    // 2 (200 + 100) / 2 / 255 and so on, as numbers of a file are: linear.
    EXPECT_TRUE(
        same_pixels(inside, picture("[1.1764705882352942, 1.4901960784313726, 1.1764705882352942]", "split")))
        << kMethodsInside[m];
  }
}

// Claim: how far cells are off random walks is said of media that are one throughout, for which it was measured, alone.
// Fails if: the mean medium's is said of one that varies.
TEST(MediumTextures, NoErrorIsSaidThatWasNotMeasured) {
  const ScratchFolder folder;
  put_png(folder.file("two.png"), 2, 2, [](int x, int) {
    return x < 1 ? Bytes{200, 160, 120} : Bytes{100, 220, 180};
  });
  const auto is_said = [&](const std::string& radius) {
    Session session;
    session.edit(
        parse_scene(wax_scene("0.8", radius, R"("method": "volume_diffusion")"), folder.file("a.json"), {}));
    return session.plan().groups.at(0).model.expected_error_of_diffusion.has_value();
  };
  EXPECT_TRUE(is_said("0.8"));
  EXPECT_FALSE(is_said(R"({"texture": "two.png"})"));
}

/// Exitance of the samples' cells.
struct CellExitance {
  std::vector<SurfaceSample> samples;
  std::vector<RgbF> values, errors;
};

/// Of a channel over the cells of walks: rms of what another method sends out there less what they do, without their noise,
/// over the mean.
double difference(const CellExitance& other, const CellExitance& walks, std::size_t channel) {
  const NearestSample nearest(walks.samples);
  std::vector<double> sums(walks.samples.size()), areas(walks.samples.size());
  for (std::size_t i = 0; i < other.samples.size(); ++i) {
    const std::uint32_t cell = nearest.at(other.samples[i].position, other.samples[i].normal);
    sums[cell] += double(other.samples[i].area) * double(other.values[i][channel]);
    areas[cell] += double(other.samples[i].area);
  }
  double square = 0, mean = 0, area = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double weight = double(walks.samples[i].area), walked = double(walks.values[i][channel]);
    square +=
        weight * (std::pow(sums[i] / areas[i] - walked, 2) - std::pow(double(walks.errors[i][channel]), 2));
    mean += weight * walked;
    area += weight;
  }
  return std::sqrt(std::max(0., square / area)) / (mean / area);
}

CellExitance exitance_of(const ScratchFolder& folder, const std::string& text) {
  Session session;
  session.edit(parse_scene(text, folder.file("scene.json"), {}));
  session.prepare();
  const Body& body = session.bodies()[0];
  EXPECT_EQ(session.world().unit, 1);
  return {body.surface.samples, cell_exitance(body), cell_error(body)};
}

// Claim: a ball whose texture has two colours, and one whose texture has two radii, send out, cell for cell, what random walks
// say, and not what a ball of the mean medium does, which is more than 10 % off. Source: the walks.
// Tolerance: 5 % rms of the mean. Fails if: what is inside is not that of the nearest place, by either method.
TEST(MediumTextures, HoldInsideAsWalked) {
  const ScratchFolder folder;
  // u runs around the ball's axis: the texture's halves are those of z or x.
  put_png(folder.file("two.png"), 64, 64, [](int x, int) {
    return x < 32 ? Bytes{230, 200, 60} : Bytes{120, 230, 240};
  });
  const std::string texture = R"({"texture": "two.png", "color_space": "linear", "uv_offset": [0.25, 0]})";
  for (const bool is_color : {true, false}) {
    const auto exitance = [&](const std::string& settings, bool is_textured) {
      const std::string varied = is_textured ? texture : "[0.686, 0.843, 0.588]",
                        other = is_color ? "1" : "0.8";
      return exitance_of(folder, wax_scene(is_color ? varied : other, is_color ? other : varied, settings,
                                           R"(, "texture_mix": "medium")"));
    };
    const CellExitance cells = exitance(R"("method": "volume_diffusion")", true),
                       walks = exitance(R"("method": "volume", "samples": 300, "until_error": 0.08)", true),
                       even = exitance(R"("method": "volume_diffusion")", false);
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LT(difference(cells, walks, c), .05) << is_color << c;
      largest = std::max(largest, difference(even, walks, c));
    }
    EXPECT_GT(largest, .1) << is_color;
  }
}

// Claim: the place of a box nearest to a point inside or outside is as far away as the box is, and on no other mesh.
// Source: the distance to a box in closed form. Fails if: a side of a triangle, or whose mesh it is, is not looked at.
TEST(NearestSurface, IsNearest) {
  const World world =
      world_of({BoxShape{{-3, -2, -1}, {3, 2, 1}}, SphereShape{{9, 0, 0}, 2, 4}}, NormalMode::faceted);
  const RayScene rays(world);
  const std::vector<std::uint32_t> box{0};
  const NearestSurface nearest(rays, box);
  for (const Vec3d& p :
       {Vec3d(0, .5, .2), Vec3d(4, 3, 2), Vec3d(-2.9, 0, 0), Vec3d(1, -5, 0), Vec3d(2.5, 1.9, .9)}) {
    const Vec3d position = into_world(world, p);
    const auto place = nearest.at(position);
    EXPECT_EQ(place.mesh, 0u);
    const Vec3d inside = component_min(component_max(p, Vec3d(-3, -2, -1)), Vec3d(3, 2, 1));
    const Vec3d room = Vec3d(3, 2, 1) - Vec3d(std::abs(p.x), std::abs(p.y), std::abs(p.z));
    const double expected = inside == p ? min_component(room) : length(p - inside);
    EXPECT_NEAR(place.distance * world.unit, expected, 1e-5);
    const SurfacePoint found = rays.surface_point(place.mesh, place.triangle, place.u, place.v);
    EXPECT_NEAR(length(Vec3d(found.position) - position) * world.unit, expected, 1e-5);
  }
}

}  // namespace
}  // namespace opaline::test
