// SPDX-License-Identifier: GPL-3.0-or-later
// What rough coats mirror is found once for a view: no ray is traced again for another colour or medium, and the picture is
// that of a new session, bit for bit.
#include "lights/environment_picture.h"
#include "session_test.h"

namespace opaline {
namespace {

using namespace test;

/// Two balls and a floor, all satin, with everything in them to be mirrored: a room, a panel, a ball of light, each other.
Scene satin_room() {
  Scene scene = two_balls();
  std::vector<RgbF> pixels;
  for (int p = 0; p < 32 * 16; ++p)
    pixels.push_back(p % 37 == 0 ? RgbF{2, 3, 4} : RgbF{.1f, .2f, .1f} * float(1 + p % 3));
  EnvironmentLight room;
  room.picture = std::make_shared<EnvironmentPicture>(32, 16, std::move(pixels));
  room.strength = {1, .9, .8};
  scene.lights = {{"key", PointLight{{0, 100, 20}, {3e4, 2e4, 1e4}}},
                  {"panel", QuadLight{{-20, 90, 30}, {40, 0, 0}, {0, 0, 20}, {5, 6, 7}}},
                  {"ball", SphereLight{{5, 30, 40}, 4, {9, 8, 7}}},
                  {"room", room}};
  for (Medium& medium : scene.media) medium.specular_roughness = .25;
  scene.shapes[2].gloss = Gloss{};
  scene.shapes[2].gloss->roughness = .2;
  scene.film.resolution = {24, 16};
  scene.film.samples_per_pixel = 2;
  scene.settings.samples = 800;
  return scene;
}

struct Edit {
  const char* name;
  std::function<void(Scene&)> apply;
  bool traces = false;  // rays for the picture
};

std::vector<Edit> edits_of_a_room() {
  return {
      {"nothing", [](Scene&) {}},
      {"point's colour",
       [](Scene& s) {
         std::get<PointLight>(s.lights[0].source).intensity = {1, 2e4, 3e4};
       }},
      {"panel's colour",
       [](Scene& s) {
         std::get<QuadLight>(s.lights[1].source).radiance = {9, 1, .3};
       }},
      {"panel black", [](Scene& s) { std::get<QuadLight>(s.lights[1].source).radiance = {}; }},
      {"panel lit",
       [](Scene& s) {
         std::get<QuadLight>(s.lights[1].source).radiance = {1, 2, 3};
       }},
      {"ball's colour",
       [](Scene& s) {
         std::get<SphereLight>(s.lights[2].source).radiance = {1, 7, .7};
       }},
      {"room's colour",
       [](Scene& s) {
         std::get<EnvironmentLight>(s.lights[3].source).strength = {.3, .7, 2};
       }},
      {"medium",
       [](Scene& s) {
         s.media[0].coefficients = PhysicalMedium{{.01, .02, .03}, {1, 2, 3}};
       }},
      {"floor's colour",
       [](Scene& s) {
         s.shapes[2].reflectance = {.1, .5, .9};
       }},
      {"a coat's roughness", [](Scene& s) { s.media[1].specular_roughness = .4; }, true},
      {"floor's roughness", [](Scene& s) { s.shapes[2].gloss->roughness = .5; }, true},
      {"a coat's anisotropy", [](Scene& s) { s.media[1].grain.anisotropy = .8; }, true},
      {"its rotation", [](Scene& s) { s.media[1].grain.rotation = 60; }, true},
      {"floor's anisotropy", [](Scene& s) { s.shapes[2].gloss->grain.anisotropy = .7; }, true},
      {"no anisotropy, with which nothing is held",
       [](Scene& s) { s.media[1].grain = s.shapes[2].gloss->grain = {}; }, true},
      {"index", [](Scene& s) { s.media[0].eta = 1.4; }, true},
      {"floor's index", [](Scene& s) { s.shapes[2].gloss->eta = 1.3; }, true},
      {"point moved", [](Scene& s) { std::get<PointLight>(s.lights[0].source).position.x = 9; }, true},
      {"room turned", [](Scene& s) { std::get<EnvironmentLight>(s.lights[3].source).rotation = 40; }, true},
      {"room's colour again",
       [](Scene& s) {
         std::get<EnvironmentLight>(s.lights[3].source).strength = {2, .1, .7};
       }},
      {"a metal", [](Scene& s) { s.shapes[2].gloss->metalness = .5; }, true},
      {"its colour",
       [](Scene& s) {
         s.shapes[2].reflectance = {.9, .5, .1};
       },
       true},
      {"no metal", [](Scene& s) { s.shapes[2].gloss->metalness = 0; }},
      {"light samples", [](Scene& s) { s.settings.light_samples = 9; }, true},
      {"seed", [](Scene& s) { s.settings.seed = 3; }, true},
      {"camera", [](Scene& s) { s.camera.position.x = 20; }, true},
      {"ball gone", [](Scene& s) { s.lights.erase(s.lights.begin() + 2); }, true},
      {"bounces", [](Scene& s) { s.settings.bounces = 1; }, true},
      {"room's colour, bouncing",
       [](Scene& s) {
         std::get<EnvironmentLight>(s.lights[2].source).strength = {1, 1, 2};
       }},
  };
}

// Claim: session.h of what a held view spares. Fails if: what is held lacks something that it depends on, or holds the
// colours of its time (another picture), or is found again without need (rays; near fields look for shadow edges again).
void expect_edits(bool near_field, int bounces = 0) {
  Scene scene = satin_room();
  scene.settings.laboratory.near_field = near_field;
  scene.settings.bounces = bounces;
  Session session;
  session.hold_view(true);
  EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
  for (const Edit& edit : edits_of_a_room()) {
    SCOPED_TRACE(edit.name);
    const Scene last = scene;
    edit.apply(scene);
    const bool traces = edit.traces && scene != last;
    session.edit(scene);
    session.prepare();
    const std::uint64_t before = session.rays().statistics().rays;
    EXPECT_TRUE(same_pixels(session.render().image, cold_picture(scene)));
    const std::uint64_t rays = session.rays().statistics().rays - before;
    EXPECT_EQ(rays > (scene.settings.bounces > 0 ? kBouncedPlaces : 0), traces || near_field);
  }
}

TEST(HeldCoats, OfOtherColoursAndMedia) {
  expect_edits(false);
}

TEST(HeldCoats, OfOtherColoursAndMediaWithNearFields) {
  expect_edits(true);
}

TEST(HeldCoats, OfOtherColoursAndMediaWhereLightBounces) {
  expect_edits(false, 1);
}

}  // namespace
}  // namespace opaline
