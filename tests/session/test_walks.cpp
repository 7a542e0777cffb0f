// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks from edit to edit.
#include "lights/light.h"
#include "methods/volume/volume_state.h"
#include "session_test.h"
#include "transport/fresnel.h"
#include "transport/laboratory.h"

namespace opaline {
namespace {

using namespace test;

/// Two lamps, and a body whose channels differ.
Scene walked_scene() {
  Scene scene = single_shape(SphereShape{{}, 3, 4}, grey_medium(1, .05, 1.3), 60);
  scene.media[0].coefficients = PhysicalMedium{{.01, .02, .05}, {1, 1.2, 1.4}};
  scene.lights = {{"key", PointLight{{0, 20, 20}, {3e3, 2e3, 1e3}}},
                  {"sun", DirectionalLight{normalized(Vec3d{0, 1, -1}), {1, 2, 3}}}};
  scene.camera.position = {0, 0, 12};
  scene.settings.method = Method::volume;
  return scene;
}

constexpr std::size_t kPasses = 16;  // of each channel and light by default

struct WalkedEdit {
  const char* name;
  std::function<void(Scene&)> edit;
  std::size_t passes;
};

// Claim: an edit walks for what it concerns: a camera and a light's colour for nothing, a light for itself in three
// channels, a medium for everything; and the picture is a new session's, bit for bit. Source: the table in session.h.
// Tolerance: none. Fails if: sums hold the lights' colours, or a key lacks what its edit changes.
TEST(Walks, EditsWalkForWhatTheyConcern) {
  const WalkedEdit edits[] = {
      {"camera",
       [](Scene& s) {
         s.camera.position = {8, 2, 9};
       },
       0},
      {"colour",
       [](Scene& s) {
         std::get<PointLight>(s.lights[0].source).intensity = {1e3, 5e3, 7e3};
       },
       0},
      {"a light moved",
       [](Scene& s) {
         std::get<DirectionalLight>(s.lights[1].source).direction = normalized(Vec3d{1, 1, -1});
       },
       3 * kPasses},
      {"a light more",
       [](Scene& s) {
         s.lights.push_back({"fill", PointLight{{-20, 0, 20}, Rgb(1e3)}});
       },
       3 * kPasses},
      {"a light less", [](Scene& s) { s.lights.pop_back(); }, 0},
      {"anisotropy", [](Scene& s) { s.media[0].scatter_anisotropy = .5; }, 6 * kPasses},
      {"re-entry", [](Scene& s) { s.settings.reenter = false; }, 6 * kPasses},
      {"seed", [](Scene& s) { s.settings.seed = 3; }, 6 * kPasses},
  };
  for (const WalkedEdit& edit : edits) {
    SCOPED_TRACE(edit.name);
    Scene scene = walked_scene();
    Session session;
    picture_of(session, scene);
    EXPECT_EQ(session.work().walk_passes, 6 * kPasses);
    edit.edit(scene);
    const Image picture = picture_of(session, scene);
    EXPECT_EQ(session.work().walk_passes, edit.passes);
    EXPECT_EQ(session.decisions().back(),
              edit.passes > 0 ? "shape: random walks traced" : "shape: random walks reused");
    EXPECT_TRUE(same_pixels(picture, cold_picture(scene)));
  }
}

// Claim: light adds up: a picture by two lights is the sum of those by each alone, and twice the colour is twice the
// picture. Source: each light's walks have random numbers of their own. Tolerance: rounding, 1e-5 of the brightest. Fails
// if: lights share walks, or a light's sums are weighted by another's colour.
TEST(Walks, LightsAddUp) {
  const Scene both = walked_scene();
  const auto by = [&](const std::vector<std::size_t>& lights, double factor) {
    Scene scene = both;
    scene.lights.clear();
    for (const std::size_t l : lights) scene.lights.push_back(both.lights[l]);
    for (Light& light : scene.lights) light = with_emission(light, emission(light) * factor);
    return cold_picture(scene);
  };
  const Image sum = by({0, 1}, 1), first = by({0}, 1), second = by({1}, 1), twice = by({0, 1}, 2);
  double brightest = 0, worst = 0, worst_twice = 0;
  for (int y = 0; y < sum.height; ++y)
    for (int x = 0; x < sum.width; ++x)
      for (const char* name : {"diffuse.R", "diffuse.G", "diffuse.B"}) {
        const double value = double(channel(sum, x, y, name));
        brightest = std::max(brightest, value);
        worst = std::max(worst, std::abs(value - double(channel(first, x, y, name)) -
                                         double(channel(second, x, y, name))));
        worst_twice = std::max(worst_twice, std::abs(2 * value - double(channel(twice, x, y, name))));
      }
  EXPECT_GT(brightest, 0);
  // Where a sum of fits is cut off at 0 it is not the sum of those that are.
  EXPECT_LT(worst, .01 * brightest);
  EXPECT_LT(worst_twice, 1e-5 * brightest);
}

// Claim: with more lights than are walked alone (four) the picture is the same within its noise, and a colour is
// walked for again. Source: volume_exitance.h. Tolerance: the means of both within 1.5 %: their noise is .4 %. Fails if:
// one of several lights is drawn by another chance than it is weighted by.
TEST(Walks, ManyLights) {
  Scene scene = walked_scene();
  scene.settings.samples = 2000;
  const auto mean = [](const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += double(channel(image, x, y, "diffuse.G"));
    return sum;
  };
  const double two = mean(cold_picture(scene));
  const std::vector<Light> lights = scene.lights;
  for (int i = 0; i < 3; ++i) {
    scene.lights.push_back({"dark " + std::to_string(i), PointLight{{0, 0, 20.0 + i}, {}}});
  }
  Session session;
  EXPECT_NEAR(mean(picture_of(session, scene)) / two, 1, .015);
  EXPECT_EQ(session.work().walk_passes, 3 * kPasses);
  scene.settings.samples = 60;  // enough for equal bits
  picture_of(session, scene);
  std::get<PointLight>(scene.lights[2].source).intensity = Rgb(1e3);
  const Image recoloured = picture_of(session, scene);
  EXPECT_EQ(session.work().walk_passes, 3 * kPasses);
  EXPECT_TRUE(same_pixels(recoloured, cold_picture(scene)));
}

/// Mean exitance of cells that `counts`, green, over what falls on them.
template <class Counts>
double mean_exitance(const Session& session, const Counts& counts) {
  const Body& body = session.bodies()[0];
  double area = 0, sum = 0;
  for (std::size_t i = 0; i < body.surface.samples.size(); ++i) {
    const SurfaceSample& s = body.surface.samples[i];
    if (!counts(out_of_world(session.world(), Vec3d(s.position)), s.normal)) continue;
    area += double(s.area);
    sum += double(s.area) * double(volume_state(body).exitance.value.exitance[i].y);
  }
  return sum / area;
}

// Claim: a medium of reduced coefficients is walked with its mean cosine g, and what a plate then sends back and lets
// through is what the laboratory finds of sigma_s = sigma_s' / (1 - g); with g = 0 it is something else. Models that know
// reduced coefficients alone keep their bytes. Source: the definition of sigma_s'. Tolerance: 2 %. Fails if: g is not
// walked, or sigma_s stays reduced.
TEST(Walks, AnisotropyIsWalked) {
  Scene scene = single_shape(SlabShape{{}, 40, 40, 1}, grey_medium(1, .05, 1.3), 2500);
  scene.lights = {{"sun", DirectionalLight{{0, -1, 0}, Rgb(1)}}};
  scene.film.resolution = {8, 8};
  const Image reduced = cold_picture(scene);
  scene.media[0].scatter_anisotropy = .8;
  EXPECT_TRUE(same_pixels(reduced, cold_picture(scene)));
  scene.settings.method = Method::volume;
  const double entered = fresnel_transmittance(1.0, 1.3);
  for (const double g : {.8, 0.}) {
    scene.media[0].scatter_anisotropy = g;
    Session session;
    session.edit(scene);
    session.prepare();
    const auto is_inner = [](const Vec3d& p) { return std::abs(p.x) < 14 && std::abs(p.z) < 14; };
    const double back = mean_exitance(session,
                                      [&](const Vec3d&p, const Vec3f&n) { return n.y > .5f && is_inner(p); }),
                 through = mean_exitance(
                     session, [&](const Vec3d&p, const Vec3f&n) { return n.y < -.5f && is_inner(p); });
    LaboratorySettings settings;
    settings.walks = 100000;
    const SlabWalks slab = walk_slab({.05, .95 / (1 - .8), .8, 1.3}, {1}, kNormalEntry, settings);
    const double off = std::abs(back / entered / slab.back.total.value - 1) +
                       std::abs(through / entered / slab.through.total.value - 1);
    if (g > 0) {
      EXPECT_LT(off, .04);
    } else {
      EXPECT_GT(off, .1);
    }
  }
}

// Claim: mean free paths that rays cannot resolve, or none at all, leave light where it enters: without absorption a
// furnace is white, and a channel that does not scatter is black. Source: the limit. Tolerance: 3 %. Fails if: such media
// are walked as they are, or 0 / 0 is taken for their albedo.
TEST(Walks, NoMeanFreePath) {
  Scene scene = single_shape(SphereShape{{}, 3, 4}, grey_medium(1e-6, 0, 1.3), 300);
  scene.lights = {{"all around", Surroundings{Rgb(1)}}};
  scene.settings.method = Method::volume;
  const auto everywhere = [](const Vec3d&, const Vec3f&) { return true; };
  const double white = kPi * (1 - average_reflectance_outside(1.3));
  for (const auto& coefficients : std::vector<decltype(Medium::coefficients)>{
           PhysicalMedium{{1, 0, 0}, {0, 1e6, 0}}, ArtistMedium{{0, 1, .5}, {0, 0, 0}, 0}}) {
    scene.media[0].coefficients = coefficients;
    Session session;
    session.edit(scene);
    session.prepare();
    EXPECT_NEAR(mean_exitance(session, everywhere) / white, 1, .03);
    for (const RgbF& value : volume_state(session.bodies()[0]).exitance.value.exitance) {
      EXPECT_TRUE(is_finite(value));
      EXPECT_EQ(value.x, 0);
    }
  }
}

// Claim: samples that lie inside the body, on an overlapping part close below the surface, darken nothing: a furnace without
// absorption is white. Source: energy is conserved, and the union has no boundary there. Tolerance: 4 % in the mean, 15 %
// at a pixel (noise). Fails if: hidden cells are interpolated (52 % of white), or keep the area that lies inside.
TEST(Walks, HiddenSamplesAreNotSeen) {
  Scene scene = single_shape(SphereShape{{}, 3, 4}, grey_medium(.3, 0, 1.3), 400);
  scene.shapes.push_back(translucent("hidden", SphereShape{{.03, .02, .08}, 2.95, 4}));
  for (Shape& shape : scene.shapes) shape.group = "body";
  scene.lights = {{"all around", Surroundings{Rgb(1)}}};
  scene.settings.method = Method::volume;
  scene.settings.reenter = false;
  const Prepared prepared(scene);
  const VolumeState& state = volume_state(prepared.bodies[0]);
  const double white = kPi * (1 - average_reflectance_outside(1.3));
  double sum = 0, area = 0, least = 2 * white;
  for (const SurfaceSample& sample : prepared.bodies[0].surface.samples) {
    if (sample.mesh != 0) continue;
    const auto value = double(state.fit->at(sample.position, sample.normal).value.x);
    sum += double(sample.area) * value;
    area += double(sample.area);
    least = std::min(least, value);
  }
  EXPECT_NEAR(sum / area / white, 1, .04);
  EXPECT_GT(least, .85 * white);
}

}  // namespace
}  // namespace opaline
