// SPDX-License-Identifier: GPL-3.0-or-later
// No length is built into a picture: scenes that differ by a scale are pictures that do not.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <string>
#include <variant>

#include "lights/light.h"
#include "methods/direct/direct.h"
#include "opaline/error.h"
#include "plan/make_plan.h"
#include "render/render.h"
#include "subsurface/method.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

/// A block, a slab and a floor under all kinds of light.
Scene plain_scene(ProfileKind profile) {
  Scene scene = single_shape(BoxShape{{-7, 2, -12}, {13, 22, 8}}, marble(), 1500);
  scene.media[0].profile = profile;
  scene.media.push_back({"artist", ArtistMedium{{.8, .5, .2}, {1, .5, .25}, .1}, 1.3, profile});
  scene.shapes.push_back(translucent("slab", SlabShape{{-18, 4, 5}, 10, 8, 3}, 1));
  Shape floor;
  floor.name = "floor";
  floor.source = QuadShape{{-60, -1, 60}, {120, 0, 0}, {0, 0, -120}};
  scene.shapes.push_back(floor);
  scene.lights = {point_light({30, 60, 40}, {9000, 8000, 7000}),
                  {"sphere", SphereLight{{-40, 40, 20}, 8, {3, 4, 5}}},
                  {"quad", QuadLight{{-10, 70, -10}, {20, 0, 0}, {0, 0, 20}, {2, 2, 2}}},
                  {"sun", DirectionalLight{normalized(Vec3d{-1, -2, -1}), {.5, .5, .4}}},
                  {"all around", Surroundings{{.2, .3, .4}}}};
  scene.camera.position = {0, 40, 80};
  scene.film.resolution = {24, 20};
  scene.settings.light_samples = 4;
  scene.settings.entry_samples = 16;
  return scene;
}

struct ScaleMedium {
  double k;
  void operator()(PhysicalMedium& m) const {
    m.sigma_a = m.sigma_a / k;
    m.sigma_s_prime = m.sigma_s_prime / k;
  }
  void operator()(ArtistMedium& m) const { m.subsurface_radius = m.subsurface_radius * k; }
};

/// The scene k times as large in every respect: irradiance and radiance stay what they are.
Scene scaled(Scene scene, double k) {
  for (Medium& medium : scene.media) std::visit(ScaleMedium{k}, medium.coefficients);
  for (Shape& shape : scene.shapes) shape.to_world = {{k, 0, 0}, {0, k, 0}, {0, 0, k}, {}};
  for (Light& light : scene.lights) light = recentred(light, {}, 1 / k);
  scene.camera.position = scene.camera.position * k;
  scene.camera.look_at = scene.camera.look_at * k;
  return scene;
}

Image picture_by_any_method(const Scene& scene) {
  if (scene.settings.method != Method::direct) return Prepared(scene).picture();
  const World world = make_world(scene);
  const RayScene rays(world);
  const Plan plan = make_plan(scene, world);
  DirectState state;
  return render_direct({scene, world, rays, plan}, state).picture.image;
}

/// All layers but positions and depth, which are compared times the scale.
void expect_same(const Image& a, const Image& b, double scale) {
  ASSERT_EQ(a.channels, b.channels);
  std::size_t other = 0, lit = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const std::string& name = a.channels[i % a.channels.size()];
    const bool is_length = name.starts_with("P.") || name == "Z";
    const float expected = is_length ? float(double(a.pixels[i]) * scale) : a.pixels[i];
    other += std::memcmp(&expected, &b.pixels[i], sizeof expected) != 0;
    lit += name == "diffuse.G" && a.pixels[i] > 0;
  }
  EXPECT_EQ(other, 0u);
  EXPECT_GT(lit, 100u);
}

// Claim: coordinates and radii times k, coefficients over k and point intensities times k^2 leave every byte
// of the picture as it is, for powers of two between 2^-58 and 2^50, by each method and profile; positions
// and depths are k times what they were. Tolerance none: every stage computes in a unit that suits the world,
// and scaling by a power of two rounds nothing. Fails if: anything is compared with an absolute length, area
// or brightness, or is squared outside of the world's space.
TEST(Scale, PowersOfTwoAreTheSamePicture) {
  for (const Method method : {Method::hierarchical, Method::direct, Method::lambert})
    for (const ProfileKind profile : {ProfileKind::dipole, ProfileKind::normalized_diffusion}) {
      Scene scene = plain_scene(profile);
      scene.settings.method = method;
      const Image plain = picture_by_any_method(scene);
      for (const double k : {0x1p-58, 0x1p-30, 2., 0x1p5, 0x1p20, 0x1p50}) {
        SCOPED_TRACE(testing::Message()
                     << "method " << int(method) << " profile " << int(profile) << " k " << k);
        expect_same(plain, picture_by_any_method(scaled(scene, k)), k);
      }
    }
}

/// The scene in light k times as bright.
Scene brighter(Scene scene, double k) {
  for (Light& light : scene.lights) light = with_emission(light, emission(light) * k);
  return scene;
}

// Claim: lights k times as bright are k times the picture, its irradiance and its estimated error, to the
// last bit, for powers of two from 2^-90 to 2^80, by sums and by caches; the mean relative error stays what
// it is. Tolerance none: scaling by a power of two rounds nothing. Fails if: a variance is kept as a float
// (the error was infinite from 2^62 on, and without its noise below 2^-50).
TEST(Scale, BrightnessTimesPowersOfTwo) {
  for (const EvaluatorKind evaluator : {EvaluatorKind::dual_tree, EvaluatorKind::surface_cache}) {
    Scene scene = plain_scene(ProfileKind::dipole);
    scene.settings.evaluator = evaluator;
    const Image plain = picture_by_any_method(scene);
    const double error = estimated_relative_error(plain);
    EXPECT_GT(error, 0);
    for (const double k : {0x1p-90, 0x1p-70, 0x1p-50, 2., 0x1p50, 0x1p62, 0x1p70, 0x1p80}) {
      const Image bright = picture_by_any_method(brighter(scene, k));
      SCOPED_TRACE(testing::Message() << "evaluator " << int(evaluator) << " k " << k);
      EXPECT_EQ(estimated_relative_error(bright), error);
      std::map<std::string, int> other;
      for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
        const std::string& name = plain.channels[i % plain.channels.size()];
        const std::string layer = name.substr(0, name.find('.'));
        const bool is_light = name == "R" || name == "G" || name == "B" || layer == "diffuse" ||
                              layer == "specular" || layer == "irradiance" || layer == "error";
        const double expected = double(plain.pixels[i]) * (is_light ? k : 1);
        other[name] += double(bright.pixels[i]) != expected;
      }
      for (const auto& [name, pixels] : other) EXPECT_EQ(pixels, 0) << name;
    }
  }
}

// Claim: the estimated noise of `direct` does not depend on the lights' brightness either. Fails if: squares
// are summed as floats (until_error then ended at once in dim light, and never in bright light).
TEST(Scale, NoiseOfDirectAtAnyBrightness) {
  Scene scene = plain_scene(ProfileKind::dipole);
  scene.settings.method = Method::direct;
  scene.settings.entry_samples = 64;
  const auto noise = [](const Scene& lit) {
    const World world = make_world(lit);
    const RayScene rays(world);
    const Plan plan = make_plan(lit, world);
    DirectState state;
    return render_direct({lit, world, rays, plan}, state).relative_error;
  };
  const double plain = noise(scene);
  EXPECT_GT(plain, 0);
  for (const double k : {0x1p-90, 0x1p-70, 0x1p70, 0x1p80}) EXPECT_EQ(noise(brighter(scene, k)), plain) << k;
}

// Claim: the same holds of the samples' places, areas and the exitance at points that a caller gives in mm.
// Tolerance none. Fails if: radiant_exitance does not bring its points into the world's unit.
TEST(Scale, ExitanceAtPointsInMillimetres) {
  const Scene scene = plain_scene(ProfileKind::dipole);
  const Prepared plain(scene);
  const std::vector<Vec3d> points{{3, 22, -2}, {13, 12, -2}};
  const std::vector<Vec3f> normals{{0, 1, 0}, {1, 0, 0}};
  const auto expected = radiant_exitance(plain.bodies[0], plain.world, points, normals, scene.settings);
  EXPECT_GT(min_component(expected[0]), 0);
  for (const double k : {0x1p-30, 0x1p20}) {
    const Prepared large(scaled(scene, k));
    std::vector<Vec3d> far;
    for (const Vec3d& p : points) far.push_back(p * k);
    EXPECT_EQ(radiant_exitance(large.bodies[0], large.world, far, normals, scene.settings), expected);
    EXPECT_EQ(large.plan.groups[0].area, plain.plan.groups[0].area * k * k);
    EXPECT_EQ(large.plan.groups[0].spacing, plain.plan.groups[0].spacing * k);
  }
}

/// What keeps a scene from being made; "" if nothing does.
std::string refusal(const Scene& scene) {
  try {
    make_plan(scene, make_world(scene));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::bad_input);
    return error.what();
  }
  return {};
}

// Claim: what single precision cannot reach from the shapes is refused by its name, with the bound. Fails if:
// check_reach is left out (the program before it passed rays to Embree that start at infinity, and aborted).
TEST(Scale, CamerasAndLightsOutOfReachAreRefused) {
  const auto refused = [](const auto& edit) {
    Scene scene = plain_scene(ProfileKind::dipole);
    for (Shape& shape : scene.shapes) shape.to_world = {{1e-9, 0, 0}, {0, 1e-9, 0}, {0, 0, 1e-9}, {}};
    scene.lights = {point_light({30e-9, 60e-9, 40e-9}, Rgb(1))};
    scene.camera.position = {0, 4e-8, 8e-8};
    edit(scene);
    return refusal(scene);
  };
  EXPECT_EQ(refused([](Scene&) {}), "");
  EXPECT_EQ(refused([](Scene& s) { s.camera.position.z = 1e5; }), "");
  EXPECT_NE(refused([](Scene& s) { s.camera.position.z = 1e7; }).find("camera.position is too far"),
            std::string::npos);
  EXPECT_NE(refused([](Scene& s) {
              s.lights[0] = point_light({1e7, 0, 0}, Rgb(1));
            }).find("'point' is too far"),
            std::string::npos);
  EXPECT_NE(refused([](Scene& s) {
              s.lights[0] = {"ball", SphereLight{{}, 1e7, Rgb(1)}};
            }).find("'ball' is too far from the shapes (expected at most "),
            std::string::npos);
  EXPECT_NE(refused([](Scene& s) {
              s.lights[0] = point_light({30e-9, 60e-9, 40e-9}, Rgb(1e20));
            }).find("'point' is too bright for shapes of this size (expected at most "),
            std::string::npos);
}

// Claim: bodies keep their picture inside of a shell 3e7 times as large, whose light they do not see.
// Tolerance: the world's middle moves, and floats round otherwise, 1e-3 of the brightest pixel. Fails if:
// lengths are told in units of the shell; the bodies' profiles then have derivatives that floats do not hold
// (NaN).
TEST(Scale, BodiesInsideOfAHugeShell) {
  Scene scene = plain_scene(ProfileKind::normalized_diffusion);
  scene.shapes.pop_back();  // the floor
  scene.lights.resize(1);
  const Image alone = picture_by_any_method(scene);
  Shape shell;
  shell.name = "shell";
  shell.source = SphereShape{{10, -20, 30}, 1e9};
  shell.reflectance = {};
  scene.shapes.push_back(shell);
  const Image inside = picture_by_any_method(scene);
  const std::size_t channels = alone.channels.size();
  float brightest = 0;
  for (std::size_t i = 0; i < alone.pixels.size(); i += channels)
    brightest = std::max(brightest, alone.pixels[i]);
  for (std::size_t i = 0; i < alone.pixels.size(); i += channels)
    ASSERT_NEAR(inside.pixels[i], alone.pixels[i], 1e-3 * double(brightest)) << i / channels;
}

}  // namespace
}  // namespace opaline::test
