// SPDX-License-Identifier: GPL-3.0-or-later
// What is held of the view from one picture to the next: less work, and a new session's pixels.
#include <cstdint>

#include "session_test.h"

namespace opaline {
namespace {

using namespace test;

/// Rays that the scene's picture takes after the session's last one; its pixels are those of a new session.
std::uint64_t rays_of_picture(Session& session, const Scene& scene) {
  session.edit(scene);
  session.prepare();
  const std::uint64_t before = session.rays().statistics().rays;
  EXPECT_TRUE(same_pixels(session.render().image, cold_picture(scene)));
  return session.rays().statistics().rays - before;
}

/// Its shadow has an edge on the balls.
Shape sheet() {
  Shape shape;
  shape.name = "sheet";
  shape.source = QuadShape{{-20, 40, 20}, {10, 0, 0}, {0, 0, -30}};
  return shape;
}

// Claim: with the view held, a picture in other colours is that of a new session beside shadow edges, too, where a light
// was black before as well. Source: held_view.h. Fails if: a near field is kept in the light that it was found in.
TEST(HeldView, NearFieldInOtherColours) {
  const struct {
    const char* name;
    Rgb before, after;
  } lines[] = {{"tinted", {3e4, 2e4, 1e4}, {2e4, 2e4, 3e4}},
               {"lit", {0, 0, 0}, {3e4, 2e4, 1e4}},
               {"brightened", {1.2e3, 8e2, 4e2}, {3e5, 2e5, 1e5}}};
  for (const auto& [name, before, after] : lines) {
    SCOPED_TRACE(name);
    Scene scene = two_balls();
    scene.film.resolution = {192, 128};
    scene.lights.erase(scene.lights.begin() + 1);  // the panel: its picture has noise of its own
    scene.shapes.push_back(sheet());
    auto& intensity = std::get<PointLight>(scene.lights[0].source).intensity;
    intensity = before;
    Session session;
    session.hold_view(true);
    EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
    intensity = after;
    EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
  }
}

// Claim: where near fields beside shadow edges share a lattice its places are held with the view, by light: in other
// colours next to no ray is traced, and whatever is edited the picture is that of a new session. Source: held_view.h.
// Fails if: places keep the light of another picture, of a light elsewhere, or of another surface.
TEST(HeldView, NearFieldPlaces) {
  Scene scene = two_balls();
  scene.film.resolution = {160, 120};
  scene.camera.position = {-12, 14, 60};
  scene.camera.look_at = {-15, 12, 0};
  scene.camera.field_of_view = 9;
  scene.settings.samples = 700;
  scene.lights.erase(scene.lights.begin() + 1);       // the panel
  for (Medium& medium : scene.media) medium.eta = 1;  // mirrors nothing
  scene.shapes.push_back(sheet());
  Session session;
  session.hold_view(true);
  session.match_new_session(true);
  const auto rays_of = [&] { return rays_of_picture(session, scene); };
  auto& intensity = std::get<PointLight>(scene.lights[0].source).intensity;
  const std::uint64_t first = rays_of();
  intensity = {2e4, 2e4, 4e4};
  EXPECT_LT(rays_of(), first / 20);
  scene.settings.seed = 3;
  rays_of();
  std::get<PointLight>(scene.lights[0].source).position.x = 4;
  rays_of();
  scene.camera.position.x = -10;
  rays_of();
  intensity = {5e4, 1e4, 1e4};
  rays_of();
  std::get<QuadShape>(scene.shapes.back().source).corner.x += 1;
  rays_of();
  scene.lights.insert(scene.lights.begin(), {"lamp", PointLight{{-40, 60, 30}, {1e4, 3e4, 1e4}}});
  rays_of();
  scene.media[0].coefficients = PhysicalMedium{{.01, .02, .03}, {1, 2, 3}};
  rays_of();
  scene.media[0].eta = 1.4;
  rays_of();
  std::get<SphereShape>(scene.shapes[0].source).radius = 11;
  rays_of();
}

// Claim: with the view held, another index of one medium has lights looked for where the camera sees that medium, and
// nowhere else. Source: held_view.h. Fails if: what lights send to other surfaces is let go of, or to this one is not.
TEST(HeldView, AnotherIndex) {
  Scene scene = two_balls();
  scene.settings.method = Method::lambert;
  scene.settings.light_samples = 32;
  scene.media[0].eta = 1.2;
  scene.media[1].eta = 1;
  Session session;
  session.hold_view(true);
  const auto rays_of = [&] { return rays_of_picture(session, scene); };
  const std::uint64_t all = rays_of();
  scene.media[0].eta = 1.4;
  const std::uint64_t once = rays_of();
  EXPECT_GT(once, 0u);
  EXPECT_LT(once, all / 2);
  scene.media[1].eta = 1.4;  // one boundary for both
  rays_of();
  scene.media[1].eta = 1.3;
  rays_of();
}

// Claim: with the view held, a light that moved is looked for by one ray from each place that it could shine
// on, and no other ray is traced; so is one that came; the picture is the cold one. One that hides part of
// the view changes what is seen. What boundaries mirror is traced anew: here they mirror nothing. Source: held_view.h. Fails if:
// another light's rays are traced again, or are taken for this one's.
TEST(HeldView, MovedLight) {
  Scene scene = two_balls();
  scene.settings.method = Method::lambert;
  for (Medium& medium : scene.media) medium.eta = 1;
  scene.lights.erase(scene.lights.begin() + 1);  // the panel
  Session session;
  session.hold_view(true);
  const Image picture = picture_of(session, scene);
  const std::size_t seen = [&] {
    std::size_t pixels = 0;
    const std::size_t alpha =
        std::size_t(std::ranges::find(picture.channels, "A") - picture.channels.begin());
    for (std::size_t i = alpha; i < picture.pixels.size(); i += picture.channels.size())
      pixels += picture.pixels[i] > 0;
    return pixels;
  }();
  const auto expect_rays = [&](std::size_t least, std::size_t most) {
    const std::uint64_t rays = rays_of_picture(session, scene);
    EXPECT_GE(rays, least);
    EXPECT_LE(rays, most);
  };
  std::get<PointLight>(scene.lights[0].source).position.x += 9;
  expect_rays(1, seen);
  std::swap(scene.lights[0], scene.lights[1]);
  expect_rays(0, 0);
  scene.lights.insert(scene.lights.begin(), {"lamp", PointLight{{0, 90, 0}, {1e4, 1e4, 1e4}}});
  expect_rays(1, seen);
  scene.lights.erase(scene.lights.begin() + 1);
  expect_rays(0, 0);
  scene.lights.push_back({"ball", SphereLight{{5, 12, 40}, 6, {9, 9, 9}}});
  expect_rays(1, seen * std::size_t(2 + scene.settings.light_samples));
  std::get<SphereLight>(scene.lights.back().source).center.x -= 9;
  expect_rays(1, seen * std::size_t(2 + scene.settings.light_samples));
}

}  // namespace
}  // namespace opaline
