// SPDX-License-Identifier: GPL-3.0-or-later
// The method `auto`: the choice for each body, and its reasons.
#include <fmt/format.h>

#include "plan/make_plan.h"
#include "plan/other_wavelengths.h"
#include "session_test.h"
#include "support/pictures.h"

namespace opaline::test {
namespace {

/// two_balls without profiles.
Scene open_choice() {
  Scene scene = two_balls();
  for (Medium& medium : scene.media) medium.profile.reset();
  return scene;
}

Scene with_method(Scene scene, Method method) {
  scene.settings.method = method;
  return scene;
}

std::vector<Method> chosen(const Scene& scene) {
  Session session;
  session.edit(scene);
  std::vector<Method> methods;
  for (const BodyPlan& body : session.plan().groups) methods.push_back(body.method);
  return methods;
}

bool has_reason(const Scene& scene, const std::string& reason) {
  Session session;
  session.edit(scene);
  return std::ranges::any_of(session.plan().stages, [&](const std::string& stage) {
    return stage.find(reason) != std::string::npos;
  });
}

// Claim: `auto` is the default, and its image is that of volume_diffusion, to the bit. Source: automatic_method.h.
// Tolerance: none. Fails if: the tree is chosen, or the scene's method is taken for a body's.
TEST(AutomaticMethod, SolvesClosedBodies) {
  const Scene scene = with_method(open_choice(), Settings().method);
  EXPECT_EQ(scene.settings.method, Method::automatic);
  EXPECT_EQ(chosen(scene), (std::vector{Method::volume_diffusion, Method::volume_diffusion}));
  EXPECT_TRUE(same_pixels(cold_picture(scene), cold_picture(with_method(scene, Method::volume_diffusion))));
}

// Claim: a body whose profile is set is that of hierarchical, to the bit, with the reason in the plan; an evaluator sets
// the method of all bodies. Source and tolerance: as above. Fails if: settings of hierarchical are ignored.
TEST(AutomaticMethod, SettingsOfHierarchicalNameIt) {
  Scene scene = with_method(open_choice(), Method::automatic);
  scene.media[0].profile = ProfileKind::dipole;
  scene.media[1].profile = ProfileKind::dipole;
  EXPECT_EQ(chosen(scene), (std::vector{Method::hierarchical, Method::hierarchical}));
  EXPECT_TRUE(has_reason(scene, "the scene sets its profile"));
  EXPECT_TRUE(same_pixels(cold_picture(scene), cold_picture(with_method(scene, Method::hierarchical))));
  scene.media[1].profile.reset();
  EXPECT_EQ(chosen(scene), (std::vector{Method::hierarchical, Method::volume_diffusion}));
  Scene classic = with_method(open_choice(), Method::automatic);
  classic.settings.evaluator = EvaluatorKind::classic;
  EXPECT_EQ(chosen(classic), (std::vector{Method::hierarchical, Method::hierarchical}));
  EXPECT_TRUE(has_reason(classic, "the scene sets the evaluator"));
}

// Claim: the choice depends on neither camera nor film. Source: automatic_method.h. Fails if: the cost of pixels counts.
TEST(AutomaticMethod, IsIndependentOfTheCamera) {
  Scene scene = with_method(open_choice(), Method::automatic);
  const std::vector<Method> methods = chosen(scene);
  scene.camera.position = {0, 400, 4000};
  scene.film.resolution = {4000, 3000};
  scene.film.samples_per_pixel = 64;
  EXPECT_EQ(chosen(scene), methods);
}

// Claim: a textured medium in an open mesh, which no cells fill, keeps its texture, as by hierarchical, to the bit.
// Source: surface_textures.cpp. Fails if: the texture is left to the inside of the body, where nothing reads it.
TEST(AutomaticMethod, OpenMeshesKeepTheirTextures) {
  const ScratchFolder folder;
  put_bytes(
      folder.file("open.obj"),
      "v -20 -20 0\nv 20 -20 0\nv 20 20 0\nv -20 20 0\nv 0 0 -20\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt .5 .5\n"
      "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 2/2 1/1 5/5\nf 3/3 2/2 5/5\n");
  put_exr(folder.file("t.exr"), 8, 1, [](int x, int) {
    return std::array<double, 3>{x % 2 ? .2 : .8, .5, .3};
  });
  const std::string text =
      R"({"media": {"m": {"subsurface_color": {"texture": "t.exr"}, "subsurface_radius": 1,
    "texture_mix": "medium"}}, "shapes": [{"file": "open.obj", "medium": "m"}],
    "lights": [{"type": "point", "position": [0, 0, 90], "intensity": 9000}],
    "camera": {"position": [0, 0, 100], "look_at": [0, 0, 0]}, "film": {"resolution": [24, 24]}})";
  EXPECT_TRUE(
      same_pixels(picture_of(folder, text), picture_of(folder, text, {"settings.method=hierarchical"})));
}

// Claim: a body with layers has cells unless these would be too many; then its equivalent medium is evaluated, to the bit
// as by hierarchical. Source: automatic_method.h. Fails if: the cells are as many as the limit, and too wide.
TEST(AutomaticMethod, LayersOfLargeBodiesAreEquivalentMedia) {
  const auto ball = [](double radius) {
    return parse_scene(fmt::format(R"({{"media": {{
        "outer": {{"sigma_a": 1, "sigma_s_prime": 30}}, "inner": {{"sigma_a": 0.1, "sigma_s_prime": 10}},
        "skin": {{"layers": [{{"medium": "outer", "thickness": 0.1}}, {{"medium": "inner"}}]}}}},
      "shapes": [{{"sphere": {{"radius": {0}}}, "medium": "skin"}}],
      "lights": [{{"type": "point", "position": [0, {1}, {1}], "intensity": 900}}],
      "camera": {{"position": [0, 0, {1}], "look_at": [0, 0, 0]}}, "film": {{"resolution": [16, 16]}},
      "settings": {{"max_samples": 20000, "samples": 2000}}}})",
                                   radius, 4 * radius),
                       "ball.json", {});
  };
  EXPECT_EQ(chosen(ball(1)), std::vector{Method::volume_diffusion});
  const Scene large = ball(10);
  EXPECT_EQ(chosen(large), std::vector{Method::hierarchical});
  EXPECT_TRUE(has_reason(large, "cells as small as its layers require"));
  EXPECT_TRUE(same_pixels(cold_picture(large), cold_picture(with_method(large, Method::hierarchical))));
}

// Claim: a layered body has the same method at all wavelengths. Source: one image. Fails if: each three wavelengths choose by their
// own decay of light.
TEST(AutomaticMethod, LayersHaveOneMethodAtAllWavelengths) {
  for (double radius = .25; radius < .8; radius *= 1.05) {
    const Scene scene = parse_scene(fmt::format(R"({{"media": {{
        "outer": {{"sigma_a": {{"nm": [400, 700], "values": [30, 0.01]}}, "sigma_s_prime": 10}},
        "inner": {{"sigma_a": {{"nm": [400, 700], "values": [30, 0.01]}}, "sigma_s_prime": 10}},
        "skin": {{"layers": [{{"medium": "outer", "thickness": 0.1}}, {{"medium": "inner"}}]}}}},
      "shapes": [{{"sphere": {{"radius": {0}}}, "medium": "skin"}}],
      "lights": [{{"type": "point", "position": [0, 90, 0], "intensity": 900}}], "film": {{"wavelengths": 12}},
      "settings": {{"max_samples": 20000, "samples": 2000}}}})",
                                                radius),
                                    "ball.json", {});
    const World world = make_world(scene);
    const Method first = make_plan(scene, world).groups.at(0).method;
    for (std::size_t g = 0; g < scene.other_wavelengths.size(); ++g)
      EXPECT_EQ(make_plan(at_other_wavelengths(scene, g), world).groups.at(0).method, first)
          << radius << " " << g;
  }
}

// Claim: the frames of an anchored session use the method of the reference frame, or warn. Source: session.h. Fails if: each frame
// chooses by its own mesh, and light jumps.
TEST(AutomaticMethod, FramesUseTheMethodOfTheReferenceFrame) {
  const auto frame = [](std::string_view shape) {
    return parse_scene(fmt::format(R"({{"media": {{"m": {{"preset": "marble"}}}},
      "shapes": [{{"name": "b", {}, "medium": "m"}}], "lights": [{{"type": "point", "position": [0, 90, 0], "intensity": 900}}]}})",
                                   shape),
                       "frame.json", {});
  };
  const Scene open = frame(R"("quad": {"corner": [0, 0, 0], "u": [0, 0, 9], "v": [9, 0, 0]})"),
              closed = frame(R"("sphere": {"radius": 9})");
  const auto plan_in = [](const Scene& reference, const Scene& scene) {
    Session session;
    session.anchor(reference);
    session.edit(scene);
    return session.plan();
  };
  EXPECT_EQ(chosen(closed), std::vector{Method::volume_diffusion});
  const BodyPlan kept = plan_in(open, closed).groups.at(0);
  EXPECT_EQ(kept.method, Method::hierarchical);
  EXPECT_TRUE(kept.reason_against_method.starts_with("as in the reference frame: its mesh is open"));
  EXPECT_EQ(plan_in(closed, closed).groups.at(0).method, Method::volume_diffusion);
  const Plan changed = plan_in(closed, open);
  EXPECT_TRUE(std::ranges::any_of(changed.warnings, [](const std::string& text) {
    return text.find("uses volume_diffusion in the reference frame") != std::string::npos;
  }));
}

// Claim: a session keeps cells that suit an edited medium, and its samples and shadow rays with them; it cuts the surface anew
// for cells too wide or too narrow, for another cell_size, and to match a new session. Source: keep_cells. Fails if: each
// edit of a medium cuts the surface (medium x 1.05), or wide cells stay in a dense medium (x 2).
TEST(AutomaticMethod, SuitableCellsAreKept) {
  const auto placed = [](double denser, double cell_size, bool matches_new) {
    Session session;
    session.match_new_session(matches_new);
    Scene scene = with_method(open_choice(), Method::automatic);
    Rgb& scattering = std::get<PhysicalMedium>(scene.media[0].coefficients).sigma_s_prime;
    scattering *= 2;  // many cells, whose size is that of the medium
    session.edit(scene);
    session.prepare();
    scattering *= denser;
    scene.settings.cell_size = cell_size;
    session.edit(scene);
    session.prepare();
    return session.work().samples_placed;
  };
  const double usual = Settings().cell_size;
  EXPECT_EQ(placed(1.05, usual, false), 0u);
  EXPECT_GT(placed(2, usual, false), 0u);
  EXPECT_GT(placed(.5, usual, false), 0u);
  EXPECT_GT(placed(1, .95 * usual, false), 0u);
  EXPECT_GT(placed(1.05, usual, true), 0u);
}

}  // namespace
}  // namespace opaline::test
