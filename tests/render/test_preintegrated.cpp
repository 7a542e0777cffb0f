// SPDX-License-Identifier: GPL-3.0-or-later
// The method that shades each hit as on a ball of the local curvature.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scratch_folder.h"
#include "diffusion/reduced_medium.h"
#include "geometry/vertex_curvature.h"
#include "methods/preintegrated/sphere_response.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"
#include "transport/fresnel.h"
#include "transport/half_space.h"

namespace opaline::test {
namespace {

constexpr double kExactMismatch = 3.95474;  // of eta 1.5, by Fresnel's equations

CalibratedMedium medium_of(double sigma_a, double sigma_s, double mismatch) {
  CalibratedMedium medium({sigma_a, sigma_s, 0, 1.5});
  medium.mismatch = mismatch;
  return medium;
}

// Claim: the zonal response of a ball is the closed form of the diffusion equation. Source: computed independently by
// modified spherical Bessel functions. Tolerance: 1e-9 without absorption, 1e-6 for a mismatch of six digits. Fails if: the derivative
// at the boundary is left out, or the source lies at the surface.
TEST(Preintegrated, ZonalResponseOfABall) {
  const std::vector<double> white = zonal_response(medium_of(0, 1, 2), 8, 1, 5);
  const std::array<double, 4> of_white{1, .75, .57421875, .351708984375},
      of_marble{.9014396350, .7948715256, .6942834685, .5337625606};
  const std::vector<double> marble = zonal_response(medium_of(.0041, 2.62, kExactMismatch), 8, 1 / 2.6241, 5);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t l = std::array<std::size_t, 4>{0, 1, 2, 4}[i];
    EXPECT_NEAR(white[l], of_white[i], 1e-9) << l;
    EXPECT_NEAR(marble[l], of_marble[i], 1e-6) << l;
  }
}

// Claim: without absorption all even light comes back, from balls of any size; a large ball is flat; a ball of no size
// scatters evenly; nothing is NaN in between. Source: energy; the half space. Tolerance: 1e-9, 1e-4. Fails if: bands of small balls are 0 / 0.
TEST(Preintegrated, Limits) {
  for (const double radius : {1e-9, 1e-3, .5, 8., 1e3, 1e9}) {
    EXPECT_NEAR(zonal_response(medium_of(0, 1, 2), radius, 40)[0], 1, 1e-9) << radius;
    const CalibratedMedium skin = medium_of(.17, .88, 3);
    for (const double value : zonal_response(skin, radius, 200))
      EXPECT_TRUE(value >= 0 && value <= 1) << radius << ' ' << value;
  }
  const CalibratedMedium marble = medium_of(.0041, 2.62, kExactMismatch);
  const double decay = std::sqrt(.0041 / marble.diffusion), depth = 1 / 2.6241;
  EXPECT_NEAR(zonal_response(marble, 1e7, depth, 1)[0],
              marble.albedo * std::exp(-decay * depth) / (1 + 2 * kExactMismatch * marble.diffusion * decay),
              1e-6);
  EXPECT_LT(zonal_response(marble, 1e-6, 3)[1], 1e-3);
  for (const CalibratedMedium& medium : {marble, medium_of(0, 1, 2), medium_of(5, .1, 1)})
    EXPECT_NEAR(kept_contrast(medium, half_contrast(medium)), .5, 1e-12);
}

// Claim: a flat body returns the exact half space's share of each direction, and light turned away gives it none; on a ball it does. Source: HalfSpace. Tolerance: 2e-3, by interpolation over the table's cosines.
TEST(Preintegrated, FlatIsTheHalfSpace) {
  const CalibratedMedium marble({.0041, 2.62, 0, 1.5});
  const SphereResponse colours({marble, marble, marble});
  const auto response_at = [&](float cosine, float curvature) { return colours.at(cosine, curvature).x; };
  const HalfSpace exact(1 - marble.albedo, 1.5);
  for (const double cosine : {.2, .5, .8, 1.}) {
    const double inside = std::sqrt(1 - (1 - cosine * cosine) / (1.5 * 1.5));
    EXPECT_NEAR(response_at(float(cosine), 0),
                cosine * fresnel_transmittance(cosine, 1.5) * exact.share(inside), 2e-3)
        << cosine;
  }
  EXPECT_EQ(response_at(-.3f, 0), 0);
  EXPECT_EQ(response_at(-.3f, -1), 0);
  EXPECT_GT(response_at(-.3f, 1 / 8.f), .02f);
  EXPECT_TRUE(std::isfinite(response_at(.3f, std::numeric_limits<float>::infinity())));
}

// Claim: the curvature of meshes is that of their surfaces. Source: by hand: 1/R; of a torus (1/r + cos v / (R + r cos v)) / 2.
// Tolerance: 2 %; .015 / mm. Fails if: the sign or the half is lost.
TEST(Preintegrated, CurvatureOfMeshes) {
  const World ball = make_world(single_shape(SphereShape{{}, 5}, marble(), 100));
  for (const float curvature : mean_curvature(ball.meshes[0], ball.meshes[0].normals))
    ASSERT_NEAR(double(curvature) / ball.unit * 5, 1, .02);
  const World ring = make_world(single_shape(TorusShape{{}, 6, 2}, marble(), 100));
  const std::vector<float> curvatures = mean_curvature(ring.meshes[0], ring.meshes[0].normals);
  const Vec3d centre = -ring.origin / ring.unit;
  for (std::size_t i = 0; i < curvatures.size(); ++i) {
    const Vec3d p = (ring.meshes[0].positions[i] - centre) * ring.unit;
    const double height = std::abs(p.y) < 2.01 ? p.y : p.z;
    const double from_axis = std::sqrt(dot(p, p) - height * height), along = (from_axis - 6) / 2;
    ASSERT_NEAR(double(curvatures[i]) / ring.unit, (1 / 2. + along / from_axis) / 2, .015) << i;
  }
}

// Claim: blurred normals of a ball stay normals of the ball where its triangles change size, and so does its curvature. Source:
// symmetry. Tolerance: a tenth of a degree; 1 %. Fails if: all neighbours of a vertex count alike.
TEST(Preintegrated, BlurKeepsABall) {
  const World ball = make_world(single_shape(SphereShape{{}, 5}, marble(), 100));
  const Mesh& mesh = ball.meshes[0];
  const std::vector<Vec3f> normals = blurred_normals(mesh, .8 / ball.unit);
  const Vec3d centre = -ball.origin / ball.unit;
  double most = 0;
  for (std::size_t i = 0; i < normals.size(); ++i)
    most = std::max(most, length(cross(Vec3d(normals[i]), normalized(mesh.positions[i] - centre))));
  EXPECT_LT(most, .1 * kPi / 180);
  for (const float curvature : mean_curvature(mesh, normals))
    ASSERT_NEAR(double(curvature) / ball.unit * 5, 1, .01);
}

// Claim: in even light, balls of any size that absorb nothing are white as diffuse reflection is; without lights they are black. Source: energy.
// Tolerance: 1 %. Fails if: only the upper hemisphere lights a ball, or its own far side hides light.
TEST(Preintegrated, Furnace) {
  for (const double radius : {.3, 3., 300.}) {
    Scene scene = single_shape(SphereShape{{}, radius}, grey_medium(1, 0, 1.3), 100);
    scene.camera.position = {0, 0, 4 * radius};
    scene.lights = {{"all around", Surroundings{Rgb(1)}}};
    scene.settings.method = Method::preintegrated;
    scene.settings.light_samples = 1024;
    const auto mean_of_middle = [](const Image& image) {
      const auto red = std::size_t(std::ranges::find(image.channels, "diffuse.R") - image.channels.begin());
      double sum = 0;
      for (std::size_t y = 13; y < 19; ++y)
        for (std::size_t x = 13; x < 19; ++x)
          sum += double(image.pixels[(y * 32 + x) * image.channels.size() + red]);
      return sum / 36;
    };
    const double reflected = mean_of_middle(cold_picture(scene));
    scene.settings.method = Method::lambert;
    EXPECT_NEAR(reflected / mean_of_middle(cold_picture(scene)), 1, .01) << radius;
    scene.settings.method = Method::preintegrated;
    scene.lights.clear();
    EXPECT_EQ(mean_of_middle(cold_picture(scene)), 0);
  }
}

// An OBJ file of a ball of radius 8, in 16 rings of quadrilaterals, with the ball's normals.
std::string coarse_ball() {
  constexpr int kRings = 16, kSides = 32;
  std::string text;
  for (int j = 0; j <= kRings; ++j)
    for (int i = 0; i < kSides; ++i) {
      const double polar = kPi * j / kRings, azimuth = 2 * kPi * i / kSides;
      const Vec3d n{std::sin(polar) * std::sin(azimuth), std::cos(polar),
                    std::sin(polar) * std::cos(azimuth)};
      text += fmt::format("v {} {} {}\nvn {} {} {}\n", 8 * n.x, 8 * n.y, 8 * n.z, n.x, n.y, n.z);
    }
  for (int j = 0; j < kRings; ++j)
    for (int i = 0; i < kSides; ++i) {
      const int a = j * kSides + i + 1, b = j * kSides + (i + 1) % kSides + 1, c = a + kSides, d = b + kSides;
      text += fmt::format("f {0}//{0} {1}//{1} {2}//{2} {3}//{3}\n", a, c, d, b);
    }
  return text;
}

std::vector<float> reds_of_ball(const std::string& shape, const std::string& camera,
                                const ScratchFolder& folder) {
  const Image image = cold_picture(parse_scene(fmt::format(R"({{
    "media": {{"m": {{"preset": "marble"}}}},
    "shapes": [{{"name": "ball", {}, "medium": "m"}}],
    "lights": [{{"name": "l", "type": "point", "position": [-30, 30, 0], "intensity": 6000}}],
    "camera": {{"position": [0, 0, 40], {}}},
    "film": {{"resolution": [120, 120]}}, "settings": {{"method": "preintegrated"}}
  }})",
                                                           shape, camera),
                                               folder.file("scene.json")));
  std::vector<float> reds;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) reds.push_back(channel(image, x, y, "diffuse.R"));
  return reds;
}

// Claim: light from behind has no holes, on a ball of few triangles and on a fine one facing the camera. Source: the
// smooth ball. Tolerance: 25 %, of facets; a hole loses all of it. Fails if: rays through the body start on its surface,
// or the body's exit is the ball's near the terminator.
TEST(Preintegrated, NoHolesOnTheFarSide) {
  const ScratchFolder folder;
  put_bytes(folder.file("ball.obj"), coarse_ball());
  const std::string fine = R"("sphere": {"radius": 8})", coarse = R"("file": "ball.obj")";
  const std::vector<float> smooth = reds_of_ball(fine, R"("field_of_view": 16)", folder),
                           faceted = reds_of_ball(coarse, R"("field_of_view": 16)", folder);
  for (std::size_t i = 0; i < smooth.size(); ++i) ASSERT_NEAR(faceted[i] / smooth[i], 1, .25) << i;
  const std::vector<float> middle = reds_of_ball(fine, R"("field_of_view": 1)", folder);
  const auto [least, most] = std::ranges::minmax(middle);
  EXPECT_GT(least, .75f * most);
}

// Claim: normal maps change light on the lit side alone, and most in the channel of the least blur. Source: behind the
// terminator, bumps lie in the body's shadow; the free paths of skin. Tolerance: 5 %, for exit by angle. Fails if: the map's
// normal tells the lit side, or the channels keep the same contrast.
TEST(Preintegrated, NormalMapsActOnTheLitSide) {
  const ScratchFolder folder;
  put_exr(folder.file("tilts.exr"), 64, 64, [](int x, int y) {
    const double tilt = (x + y) % 2 == 0 ? .3 : -.3;
    return std::array{.5 + .5 * std::sin(tilt), .5, .5 + .5 * std::cos(tilt)};
  });
  const auto picture = [&](const std::string& map) {
    return picture_of(folder, R"({"media": {"m": {"preset": "skin1"}},
      "shapes": [{"sphere": {"radius": 20}, "medium": "m")" +
                                  map + R"(}],
      "lights": [{"type": "directional", "direction": [-1, 0, 0], "irradiance": 3}],
      "camera": {"position": [0, 0, 200], "orthographic_height": 40},
      "film": {"resolution": [81, 81], "pixel_type": "float"},
      "settings": {"method": "preintegrated"}})");
  };
  const Image plain = picture(""), mapped = picture(R"(, "normal_map": {"texture": "tilts.exr"})");
  std::array<double, 3> contrast{};
  for (int y = 20; y <= 60; ++y)
    for (int x = 20; x <= 60; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::string name = std::array{"diffuse.R", "diffuse.G", "diffuse.B"}[c];
        const double before = double(channel(plain, x, y, name)), after = double(channel(mapped, x, y, name));
        if (x < 40) {
          ASSERT_NEAR(after, before, .05 * before + 1e-6) << x << ' ' << y;
        } else if (x > 50) {
          contrast[c] += std::abs(after / before - 1);
        }
      }
  EXPECT_GT(contrast[0], 1);
  EXPECT_LT(1.5 * contrast[0], contrast[1]);
  EXPECT_LT(1.5 * contrast[1], contrast[2]);
}

// Claim: another profile of an artist's medium is noticed, as its colour then is another medium. Source: a new session. Fails if: the
// key of the tables has the colour and radius alone.
TEST(Preintegrated, NoticesTheProfile) {
  Scene scene = single_shape(SphereShape{{}, 5}, marble(), 100);
  scene.media[0].coefficients = ArtistMedium{Rgb(.6), Rgb(1)};
  scene.lights = {point_light({20, 30, 60}, Rgb(1e4))};
  scene.settings.method = Method::preintegrated;
  Session session;
  const Image before = picture_of(session, scene);
  scene.media[0].profile = ProfileKind::normalized_diffusion;
  const Image edited = picture_of(session, scene);
  EXPECT_TRUE(same_pixels(edited, cold_picture(scene)));
  EXPECT_FALSE(same_pixels(edited, before));
}

}  // namespace
}  // namespace opaline::test
