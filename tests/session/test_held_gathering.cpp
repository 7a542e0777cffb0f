// SPDX-License-Identifier: GPL-3.0-or-later
// Rays that gather light from surfaces to others are traced once for a view, and those at samples once for the samples.
#include "render/render.h"
#include "session_test.h"
#include "subsurface/held_view.h"

namespace opaline {
namespace {

using namespace test;

/// The balls shine on the floor and it on them, also where the camera sees only its mirror image.
Scene balls_and_light() {
  Scene scene = two_balls();
  scene.settings.bounces = 1;
  scene.settings.samples = 800;
  scene.settings.laboratory.near_field = false;
  scene.settings.evaluator = EvaluatorKind::dual_tree;  // `automatic` looks at some pixels first
  for (Medium& medium : scene.media) medium.specular_roughness = .25;
  scene.film.resolution = {24, 16};
  scene.film.samples_per_pixel = 2;
  return scene;
}

/// A strip of stone, narrower than a pixel, that no place of BouncedPlaces lies on. Along a part of it the top of a block
/// lies in its plane; the block's places stand for the strip as long as both have one index. A ball lights both.
Scene strip_beside_block() {
  Scene scene;
  scene.media = {marble()};
  scene.shapes = {translucent("block", BoxShape{{-20, 0, -10}, {-.8, 10, 10}})};
  const auto add_stone = [&](const char* name, ShapeSource source) -> Shape& {
    scene.shapes.emplace_back();
    scene.shapes.back().name = name;
    scene.shapes.back().source = std::move(source);
    return scene.shapes.back();
  };
  add_stone("strip", QuadShape{{-.8, 10, 30}, {1.6, 0, 0}, {0, 0, -60}}).gloss = Gloss{.eta = 1.5};
  add_stone("ball", SphereShape{{12, 16, 0}, 8});
  scene.lights = {point_light({-30, 100, 20}, Rgb(3e4))};
  scene.camera.position = {0, 100, 40};
  scene.camera.look_at = {0, 10, 0};
  scene.camera.field_of_view = 32;
  scene.film.resolution = {24, 16};
  scene.film.samples_per_pixel = 4;
  scene.film.half = false;
  scene.settings.bounces = 1;
  scene.settings.samples = 800;
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  return scene;
}

struct Held {
  Session session;
  Scene scene;

  explicit Held(Scene s = balls_and_light()) : scene(std::move(s)) {
    session.hold_view(true);
    session.match_new_session(true);
    picture_of(session, scene);
  }
  /// Rays of a whole edit; the picture is that of a new session.
  std::uint64_t rays() {
    const std::uint64_t before = session.rays().statistics().rays;
    EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
    return session.rays().statistics().rays - before;
  }
};

// Claim: with the view held, an edit of a colour or medium gathers at what rays met before: of all rays only those that
// look for BouncedPlaces are traced. Source: held_view.h. Fails if: samples, places or the hits that no place stands for
// trace theirs again, or the lights at what these met (without kept rays: 100 times as many).
TEST(HeldGathering, ColoursAndMediaTraceNothing) {
  Held held;
  const auto expect_none = [&](const char* what) {
    SCOPED_TRACE(what);
    EXPECT_LE(held.rays(), kBouncedPlaces);
  };
  std::get<PointLight>(held.scene.lights[0].source).intensity = {1e4, 3e4, 2e4};
  expect_none("a point light");
  std::get<QuadLight>(held.scene.lights[1].source).radiance = {1, 2, 9};
  expect_none("a panel");
  const double largest = max_component(held.scene.shapes[2].reflectance);
  held.scene.shapes[2].reflectance = {largest, .2, .1};
  expect_none("the floor's hue");
  held.scene.media[0].coefficients = PhysicalMedium{{.01, .02, .03}, {1, 2, 3}};
  expect_none("a medium");
}

// Claim: an edit of a reflectance traces no more than the paths of further bounces, chosen by reflectances. Tolerance: a
// quarter of the first image's rays. Fails if: rays of the first bounce are traced again.
TEST(HeldGathering, ReflectancesTraceFurtherBouncesAlone) {
  Held held;
  const std::uint64_t first = held.session.rays().statistics().rays;
  held.scene.shapes[2].reflectance = {.8, .2, .1};
  const std::uint64_t again = held.rays();
  EXPECT_GT(again, kBouncedPlaces);
  EXPECT_LT(again, first / 4);
}

// Claim: a light that moved is looked for from what gathered rays met, and another index weighs them anew. Source:
// held_view.h. Fails if: one is kept of the light before it moved (set_lights), or of the boundary before (set_fields).
TEST(HeldGathering, LightsThatMoveAndBoundaries) {
  Held held;
  const auto edit = [&](const char* what, const std::function<void(Scene&)>& apply) {
    SCOPED_TRACE(what);
    apply(held.scene);
    EXPECT_GT(held.rays(), kBouncedPlaces);
  };
  edit("point moved", [](Scene& s) { std::get<PointLight>(s.lights[0].source).position.x = 9; });
  edit("panel moved", [](Scene& s) { std::get<QuadLight>(s.lights[1].source).corner.x = -9; });
  edit("light gone", [](Scene& s) { s.lights.erase(s.lights.begin()); });
  edit("index", [](Scene& s) { s.media[0].eta = 1.4; });
  edit("index of the other", [](Scene& s) { s.media[0].eta = s.media[1].eta; });
  edit("index again", [](Scene& s) { s.media[0].eta = 1.5; });
  edit("seed", [](Scene& s) { s.settings.seed = 3; });
  edit("camera", [](Scene& s) { s.camera.position.x = 20; });
  edit("floor moved", [](Scene& s) { std::get<QuadShape>(s.shapes[2].source).corner.y = -3; });
  edit("samples", [](Scene& s) { s.settings.samples = 600; });
  edit("shape gone", [](Scene& s) { s.shapes.erase(s.shapes.begin()); });
}

// Claim: where places of another surface cease to stand for hits, these hits gather for themselves: what others of their
// batch gathered before is not theirs. Source: held_view.h, Gathering::points. Fails if: what is kept of hits is used for
// whichever hits gather now (of_points in bounced_light.cpp): hits between block and strip would then have no light from
// the ball, and the strip's free ends that of others.
TEST(HeldGathering, OtherHitsGather) {
  Held held(strip_beside_block());
  const auto edit = [&](const char* what, const std::function<void(Scene&)>& apply) {
    SCOPED_TRACE(what);
    apply(held.scene);
    held.rays();
  };
  edit("another index", [](Scene& s) { s.media[0].eta = 1.4; });
  edit("that of the strip", [](Scene& s) { s.media[0].eta = 1.5; });
  edit("a block without places", [](Scene& s) { s.settings.laboratory.near_field = false; });
  edit("with places", [](Scene& s) { s.settings.laboratory.near_field = true; });
}

// Claim: closer places are chosen by the light there is, and what those of other light gathered is not theirs. Source:
// bounced_light.h. Fails if: what is kept is known by a place's number among those that gather at once.
TEST(HeldGathering, CloserPlacesOfOtherLight) {
  Scene scene = balls_and_light();
  scene.film.resolution = {192, 144};
  scene.lights[0] = {"low", PointLight{{-40, 6, 30}, Rgb(2e4)}};
  Held held(scene);
  const auto edit = [&](const char* what, const Rgb& point, const Rgb& panel) {
    SCOPED_TRACE(what);
    std::get<PointLight>(held.scene.lights[0].source).intensity = point;
    std::get<QuadLight>(held.scene.lights[1].source).radiance = panel;
    held.rays();
  };
  edit("the panel alone", {}, Rgb(3));
  edit("the point alone", {1e4, 3e4, 2e4}, {});
  edit("both", Rgb(2e4), Rgb(9));
}

// Claim: no more is held of gathered rays than kMostGatheredBytes; the picture is the same. Source: held_view.h. Fails if:
// what rays met is held without a look at what there is.
TEST(HeldGathering, HasABound) {
  const Prepared balls(balls_and_light());
  const auto parts_of = [&](std::size_t bytes_before) {
    HeldView view;
    *view.gathered_bytes = bytes_before;
    const Image picture = render({balls.scene, balls.world, balls.rays, balls.bodies, nullptr, &view}).image;
    EXPECT_TRUE(same_pixels(picture, balls.picture()));
    std::size_t parts = 0;
    for (const std::vector<HeldView::Gathering>& chunk : view.at_places)
      for (const HeldView::Gathering& gathering : chunk)
        for (const HeldView::Gathered& part : gathering.parts) parts += part.is_traced;
    EXPECT_EQ(*view.gathered_bytes > bytes_before, parts > 0);
    return parts;
  };
  EXPECT_GT(parts_of(0), 0u);
  EXPECT_EQ(parts_of(kMostGatheredBytes), 0u);
}

}  // namespace
}  // namespace opaline
