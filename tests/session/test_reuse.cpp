// SPDX-License-Identifier: GPL-3.0-or-later
// Edits that leave the surfaces as they are: each row of the table in session.h recomputes what it says, and
// the picture is a new session's, bit for bit. Every test fails if a key lacks what its edit changes (another
// picture) or has more (more work).
#include <fmt/format.h>

#include <cstring>
#include <thread>

#include "plan/make_plan.h"
#include "session_test.h"

namespace opaline {
namespace {

using namespace test;

struct Row {
  const char* name;
  std::function<void(Scene&)> edit;
  std::size_t lights_traced = 0;
  bool builds_trees = false;
};

void expect_row(const Row& row, bool hold_view) {
  SCOPED_TRACE(fmt::format("{}, view {}", row.name, hold_view ? "held" : "not held"));
  Scene scene = two_balls();
  Session session;
  session.hold_view(hold_view);
  picture_of(session, scene);
  EXPECT_EQ(session.work().meshes_loaded, 3u);
  EXPECT_GT(session.work().samples_placed, 4500u);
  EXPECT_EQ(session.work().lights_traced, 6u);
  row.edit(scene);
  const Image picture = picture_of(session, scene);
  const SessionWork& work = session.work();
  EXPECT_EQ(work.meshes_loaded, 0u);
  EXPECT_EQ(work.samples_placed + work.samples_carried + work.samples_removed, 0u);
  EXPECT_EQ(work.lights_traced, row.lights_traced);
  EXPECT_EQ(work.sample_rays > 0, row.lights_traced > 0);
  EXPECT_EQ(work.nodes_built > 0, row.builds_trees);
  if (!row.builds_trees) {
    EXPECT_EQ(work.ray_builds, 0u);
  }
  EXPECT_GT(work.queries, 0u);
  EXPECT_TRUE(same_pixels(picture, cold_picture(scene)));
}

void expect_row(const Row& row) {
  expect_row(row, false);
  expect_row(row, true);
}

// Claim: camera, film and exposure cost camera rays and evaluation alone. Source: the table in session.h.
TEST(Reuse, CameraAndFilm) {
  for (const Row& row : {
           Row{"nothing", [](Scene&) {}},
           Row{"camera",
               [](Scene& s) {
                 s.camera.position = {80, 20, 90};
               }},
           Row{"lens", [](Scene& s) { s.camera.field_of_view = 12; }},
           Row{"film",
               [](Scene& s) {
                 s.film.resolution = {31, 17}, s.film.samples_per_pixel = 2;
               }},
           Row{"exposure", [](Scene& s) { s.film.exposure = 2; }},
           Row{"crop",
               [](Scene& s) {
                 s.film.crop = {{4, 5, 20, 30}};
               }},
       })
    expect_row(row);
}

// Claim: with a surface cache a camera edit evaluates nothing anew, and edits of light, medium or tolerance
// do; the picture is the cold one either way. Left to itself a session makes one when the pictures it expects
// pay for it. Source: session.h. Fails if: exitance_key lacks the kernel or the tolerance, or the count of
// pictures is not used.
TEST(Reuse, SurfaceCache) {
  Scene scene = two_balls();
  scene.settings.evaluator = EvaluatorKind::surface_cache;
  Session session;
  picture_of(session, scene);
  const std::size_t places = session.work().places_evaluated;
  EXPECT_GT(places, 0u);
  scene.camera.position = {80, 20, 90};
  EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
  EXPECT_EQ(session.work().places_evaluated, 0u);
  const std::vector<std::function<void(Scene&)>> edits = {
      [](Scene& s) {
        std::get<PointLight>(s.lights[0].source).intensity = {1, 2e4, 9};
      },
      [](Scene& s) { s.media[0].profile = ProfileKind::normalized_diffusion; },
      [](Scene& s) { s.settings.tolerance = .02; }};
  for (std::size_t e = 0; e < edits.size(); ++e) {
    edits[e](scene);
    EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene))) << e;
    EXPECT_GT(session.work().places_evaluated, 0u) << e;
  }
  scene.settings.evaluator = EvaluatorKind::automatic;
  Session alone, many;
  many.expect_pictures(100000);
  EXPECT_TRUE(same_pixels(picture_of(alone, scene), cold_picture(scene)));
  EXPECT_EQ(alone.work().places_evaluated, 0u);
  picture_of(many, scene);
  EXPECT_GT(many.work().places_evaluated, 0u);
}

// Claim: colours and power of all kinds of lights trace no ray from a sample. Source: the table in session.h.
TEST(Reuse, LightColour) {
  expect_row({"point",
              [](Scene& s) {
                std::get<PointLight>(s.lights[0].source).intensity = {1, 2e4, 9};
              },
              0, true});
  expect_row({"quad",
              [](Scene& s) {
                std::get<QuadLight>(s.lights[1].source).radiance = {70, 0, 7};
              },
              0, true});
  expect_row(
      {"sun", [](Scene& s) { std::get<DirectionalLight>(s.lights[2].source).irradiance = {}; }, 0, true});
}

// Claim: a medium's coefficients and profile, and what evaluation is asked for, cost evaluation alone; eta
// the light that enters that medium's group. Source: the table in session.h.
TEST(Reuse, Medium) {
  expect_row({"coefficients", [](Scene& s) {
                s.media[0].coefficients = PhysicalMedium{{.01, .02, .03}, {1, 2, 3}};
              }});
  expect_row({"profile", [](Scene& s) { s.media[1].profile = ProfileKind::normalized_diffusion; }});
  expect_row({"artist's", [](Scene& s) {
                s.media[0].coefficients = ArtistMedium{{.8, .7, .6}, {1, 2, 3}, .1};
              }});
  expect_row({"evaluator", [](Scene& s) { s.settings.evaluator = EvaluatorKind::classic; }});
  expect_row({"near field", [](Scene& s) { s.settings.laboratory.near_field = false; }});
  expect_row({"eta", [](Scene& s) { s.media[0].eta = 1.4; }, 3, true});
}

// Claim: a light that moved, came, went, changed its size or its name (its random numbers) costs its own rays
// from each group, and no other's; lights of no area have no random numbers. Source: the table in session.h.
TEST(Reuse, Lights) {
  expect_row(
      {"point moved", [](Scene& s) { std::get<PointLight>(s.lights[0].source).position.x = 9; }, 2, true});
  expect_row({"quad moved", [](Scene& s) { std::get<QuadLight>(s.lights[1].source).corner.x = 9; }, 2, true});
  expect_row({"sun turned",
              [](Scene& s) {
                std::get<DirectionalLight>(s.lights[2].source).direction = {0, -1, 0};
              },
              2, true});
  expect_row({"first removed", [](Scene& s) { s.lights.erase(s.lights.begin()); }, 0, true});
  expect_row({"reordered", [](Scene& s) { std::swap(s.lights[0], s.lights[2]); }, 0, true});
  expect_row({"sphere added",
              [](Scene& s) {
                s.lights.insert(s.lights.begin(), {"ball", SphereLight{{50, 50, 50}, 5, {9, 9, 9}}});
              },
              2, true});
  expect_row({"surroundings added",
              [](Scene& s) {
                s.lights.push_back({"sky", Surroundings{{1, 1, 1}}});
              },
              2, true});
  expect_row({"light samples", [](Scene& s) { s.settings.light_samples = 9; }, 2, true});
  expect_row({"area light renamed", [](Scene& s) { s.lights[1].name = "window"; }, 2, true});
  expect_row({"point renamed", [](Scene& s) { s.lights[0].name = "lamp"; }});
}

// Claim: methods without samples make none; back again, they are still there. Source: "what depends on it".
TEST(Reuse, Methods) {
  Scene scene = two_balls();
  Session session;
  scene.settings.method = Method::lambert;
  picture_of(session, scene);
  EXPECT_EQ(session.work().samples_placed, 0u);
  scene.settings.method = Method::hierarchical;
  const Image picture = picture_of(session, scene);
  EXPECT_GT(session.work().samples_placed, 0u);
  scene.settings.method = Method::lambert;
  EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
  scene.settings.method = Method::hierarchical;
  EXPECT_TRUE(same_pixels(picture_of(session, scene), picture));
  EXPECT_EQ(session.work().samples_placed + session.work().nodes_built, 0u);
}

// Claim: without a number of samples in the settings a medium's samples stay while they are as dense as it
// asks for and at most twice as dense, and so the picture is that of this many samples; beyond, they are
// placed anew and it is the cold one. Source: session.h; the spacing is one and a half mean free
// paths, 1/6 mm in blue.
// Fails if: the rule looks at one side only.
TEST(Reuse, SpacingStillValid) {
  Scene scene = two_balls();
  scene.settings.samples = {};
  const auto scaled = [&](double by) {
    Scene edited = scene;
    edited.media[0].coefficients = PhysicalMedium{{.002, .004, .007}, Rgb{6, 7.5, 9} * by};
    return edited;
  };
  const struct {
    double by;
    bool stays;
  } lines[] = {{1.05, true}, {1.25, false}, {.6, true}, {.4, false}};
  for (const auto& [by, stays] : lines) {
    Session session;
    picture_of(session, scaled(1));
    Scene edited = scaled(by);
    const Image picture = picture_of(session, edited);
    EXPECT_EQ(session.work().samples_placed + session.work().nodes_built == 0, stays) << by;
    EXPECT_EQ(session.work().lights_traced, stays ? 0u : 3u) << by;
    const Image cold = cold_picture(edited);
    EXPECT_EQ(same_pixels(picture, cold), !stays) << by;
    EXPECT_LT(difference(picture, cold), .01) << by;
  }
}

// Claim: what no row of the table knows is computed again where it matters, and said. Source: session.h's
// last row. Fails if: seed or count are in no key.
TEST(Reuse, AnythingElse) {
  const std::vector<std::function<void(Scene&)>> edits = {
      [](Scene& s) { s.settings.seed = 7; },
      [](Scene& s) { s.settings.samples = 5000; },
      [](Scene& s) { s.shapes[0].normals = NormalMode::faceted; },
      [](Scene& s) { s.shapes[0].group = s.shapes[1].group = "both", s.shapes[1].medium = 0; },
      [](Scene& s) {
        s.shapes[0].source = TorusShape{{-15, 10, 0}, 8, 3};
      },
      [](Scene& s) { s.shapes.erase(s.shapes.begin()); },
  };
  for (const auto& edit : edits) {
    Scene scene = two_balls();
    Session session;
    picture_of(session, scene);
    edit(scene);
    const Image picture = picture_of(session, scene);
    EXPECT_FALSE(session.decisions().empty());
    EXPECT_TRUE(same_pixels(picture, cold_picture(scene)));
  }
}

// Claim: the structure that rays walk is built quickly where one picture's rays are few for its triangles,
// and carefully for area lights of many rays, large pictures and `direct`, by the scene alone; it is built
// anew where this changes, and then only. Source: Plan::rays. Fails if: no ray counts, or all count alike.
TEST(Reuse, RayBuild) {
  Scene scene = two_balls();
  scene.lights.erase(scene.lights.begin() + 1);  // the panel
  Session session;
  const auto expect = [&](RayBuild build, std::size_t builds) {
    EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
    EXPECT_EQ(session.plan().rays, build);
    EXPECT_EQ(session.work().ray_builds, builds);
  };
  expect(RayBuild::quick, 1);
  scene.camera.position.x += 5;
  expect(RayBuild::quick, 0);
  Scene large = scene;
  large.film.resolution = {4096, 4096};
  EXPECT_EQ(make_plan(large, session.world()).rays, RayBuild::careful);
  scene.lights.push_back({"panel", QuadLight{{-20, 90, 30}, {40, 0, 0}, {0, 0, 20}, {5, 6, 7}}});
  scene.settings.light_samples = 64;
  expect(RayBuild::careful, 1);
  scene.settings.light_samples = 65;
  expect(RayBuild::careful, 0);
  scene.lights.clear();
  expect(RayBuild::quick, 1);
  scene.settings.method = Method::direct;
  EXPECT_EQ(make_plan(scene, session.world()).rays, RayBuild::careful);
}

// Claim: in a scene without lights nothing is precomputed, and light that comes back finds the samples of before.
// Source: such an image is black. Fails if: its bodies are sampled, or samples go with the lights.
TEST(Reuse, NoLights) {
  const Scene lit = two_balls();
  Scene dark = lit;
  dark.lights.clear();
  for (const Method method : {Method::hierarchical, Method::volume_diffusion, Method::volume}) {
    Session session;
    dark.settings.method = method;
    const Image black = picture_of(session, dark);
    EXPECT_EQ(session.work().samples_placed, 0u);
    EXPECT_EQ(channel(black, black.width / 2, black.height / 2, "R"), 0);
  }
  dark.settings.method = lit.settings.method;
  for (const bool hold_view : {false, true}) {
    Session session;
    session.hold_view(hold_view);
    const Image before = picture_of(session, lit);
    EXPECT_TRUE(same_pixels(picture_of(session, dark), cold_picture(dark)));
    EXPECT_EQ(session.work().lights_traced + session.work().nodes_built, 0u);
    EXPECT_TRUE(same_pixels(picture_of(session, lit), before));
    EXPECT_EQ(session.work().samples_placed, 0u);
  }
}

// Claim: an edit that cannot be loaded leaves the session with the scene before. Source: session.h. Fails if:
// edit assigns before it has loaded.
TEST(Reuse, BadEdit) {
  Scene scene = two_balls();
  Session session;
  const Image before = picture_of(session, scene);
  scene.shapes[1].source = MeshFile{"/nonexistent/mesh.ply", false, {}};
  EXPECT_ANY_THROW(session.edit(scene));
  EXPECT_TRUE(same_pixels(session.render().image, before));
}

// Claim: work that was interrupted anywhere is taken up again and ends in the same picture. Source:
// session.h. Fails if: a result is under its key before it is whole.
TEST(Reuse, Interrupted) {
  Scene scene = two_balls();
  const Image expected = cold_picture(scene);
  for (std::size_t budget = 1; budget < 60000; budget = 3 * budget + 1) {
    Session session;
    session.edit(scene);
    Monitor monitor;
    std::thread canceller([&] {
      while (monitor.done < budget && !monitor.cancelled) std::this_thread::yield();
      monitor.cancelled = true;
    });
    try {
      session.prepare(&monitor);
    } catch (const std::exception&) {
    }
    monitor.cancelled = true;
    canceller.join();
    ASSERT_TRUE(same_pixels(session.render().image, expected)) << budget;
  }
}

/// two_balls, whose surfaces light each other once.
Scene balls_that_bounce() {
  Scene scene = two_balls();
  scene.settings.bounces = 1;
  scene.settings.samples = 800;
  return scene;
}

// Claim: a render that is cancelled before it gathers bounced light for the camera leaves the bodies unchanged: the next
// image is that of a new session. Source: session.h. Fails if: an interrupted DirectlyLitBodies (update_bounces.cpp) has
// taken the light of a body: one body is then black, and others have no bounced light.
TEST(Reuse, CancelledBeforeBouncedPlaces) {
  for (const Method method : {Method::hierarchical, Method::volume_diffusion})
    for (const bool hold_view : {false, true}) {
      Scene scene = balls_that_bounce();
      scene.settings.method = method;
      Session session;
      session.hold_view(hold_view);
      picture_of(session, scene);
      scene.camera.position.x = 20;
      session.edit(scene);
      session.prepare();
      Monitor monitor;
      monitor.cancelled = true;
      EXPECT_THROW(session.render(&monitor), Error);
      EXPECT_TRUE(same_pixels(session.render().image, cold_picture(scene)));
    }
}

// Claim: each method gathers bounced light from its own bodies, also if its other results are reused. Source: session.h.
// Fails if: the key of bounced places contains keys that belong to the method before.
TEST(Reuse, MethodsInTurnGatherTheirBouncedLight) {
  Scene scene = balls_that_bounce();
  scene.settings.light_samples = 256;  // fewer: the methods' ray structures differ, and hence their keys
  Session session;
  for (const Method method :
       {Method::volume_diffusion, Method::hierarchical, Method::volume_diffusion, Method::hierarchical}) {
    scene.settings.method = method;
    EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
  }
}

// Claim: a method without samples ignores the bodies that another method prepared. Source: session.h. Fails if: their
// irradiance is computed for lights added since, from which they have no transfer (an invalid read).
TEST(Reuse, LightsAddedWithoutSamples) {
  Scene scene = balls_that_bounce();
  Session session;
  picture_of(session, scene);
  scene.settings.method = Method::lambert;
  for (int i = 0; i < 8; ++i) scene.lights.push_back({"sun", DirectionalLight{{0, -1, 0}, {1, 1, 1}}});
  EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
}

// Claim: a scene without translucent shapes ignores the bodies of the scene before. Source: session.h. Fails if: they are
// rendered, for their meshes no longer exist (an invalid write).
TEST(Reuse, LastTranslucentShapeGone) {
  Scene scene = balls_that_bounce();
  std::rotate(scene.shapes.begin(), scene.shapes.begin() + 2, scene.shapes.end());
  Session session;
  picture_of(session, scene);
  EXPECT_EQ(session.bodies().size(), 2u);
  scene.shapes.resize(1);
  EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
  EXPECT_TRUE(session.bodies().empty());
}

}  // namespace
}  // namespace opaline
