// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "session/session_records.h"
#include "support/scenes.h"
#include "transport/fresnel.h"

namespace opaline::test {
namespace {

// Claim: without absorption under uniform radiance 1, a sphere sends back CDF(2R) Ft + F towards the camera:
// all but what the infinite plane would have returned from beyond 2R. Source: energy convention of render.h;
// M_o = E CDF(2R) holds for any radial profile on a sphere. Tolerance .7 % over the picture (64 surroundings
// rays and 20k samples), 3 % a pixel (largest sampling error measured: 2.7 %).
// Fails when: Ft is left out of E (E is 10 % high), F_bar is replaced by the internal F_dr, or areas do not
// sum to the mesh area.
void expect_furnace(ProfileKind profile, double eta) {
  const double radius = 25, mean_free_path = 0.5;
  Scene scene = single_shape(SphereShape{{}, radius}, grey_medium(mean_free_path, 0, eta, profile), 20000);
  scene.lights = {{"all around", Surroundings{Rgb(1.0)}}};
  scene.film.resolution = {24, 24};
  scene.camera.field_of_view = 31;
  const Prepared prepared(scene);
  const Image image = prepared.picture();
  const DiffuseProfile diffuse = make_diffuse_profile(scene.media[0]);
  const double returned = diffuse_reflectance_within(diffuse.channels[1], 2 * radius);
  double sum = 0, expected_sum = 0;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) {
      if (channel(image, x, y, "A") < 1) continue;
      const Vec3d position{channel(image, x, y, "P.X"), channel(image, x, y, "P.Y"),
                           channel(image, x, y, "P.Z")};
      const Vec3d normal{channel(image, x, y, "N.X"), channel(image, x, y, "N.Y"),
                         channel(image, x, y, "N.Z")};
      const double cosine = std::abs(dot(normalized(scene.camera.position - position), normal));
      const double reflected = fresnel_reflectance(cosine, eta);
      const double expected = returned * (1 - reflected) + reflected;
      EXPECT_NEAR(channel(image, x, y, "G"), expected, 0.03) << x << ' ' << y;
      sum += channel(image, x, y, "G");
      expected_sum += expected;
    }
  ASSERT_GT(expected_sum, 100);
  EXPECT_NEAR(sum / expected_sum, 1, 0.007);
}

// Claim: by `volume` a sphere that absorbs nothing looks like its surroundings, with no loss to the far side, for
// walks leave where the body ends. Source: conservation. Tolerance: 1.5 % over the picture (its walks' noise: .4 %,
// measured), and a warm camera walks nothing. Fails when: light that leaves is not counted on the cell where it
// does, the boundary's Ft is left out of the way in or out, or the walks' key holds the camera.
TEST(WhiteFurnace, VolumeSphere) {
  for (const double eta : {1.0, 1.5}) {
    Scene scene = single_shape(SphereShape{{}, 4}, grey_medium(1, 0, eta), 500);
    scene.lights = {{"all around", Surroundings{Rgb(1.0)}}};
    scene.film.resolution = {48, 48};
    scene.settings.method = Method::volume;
    Session session;
    for (const double distance : {20.0, 30.0}) {
      scene.camera.position = {0, 0, distance};
      session.edit(scene);
      const Image image = session.render().image;
      double sum = 0;
      int lit = 0;
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x)
          if (channel(image, x, y, "A") == 1) sum += channel(image, x, y, "G"), ++lit;
      ASSERT_GT(lit, 200);
      EXPECT_NEAR(sum / lit, 1, 0.015) << eta;
      EXPECT_EQ(session.decisions().back(),
                distance == 20 ? "shape: random walks traced" : "shape: random walks reused");
    }
  }
}

TEST(WhiteFurnace, DipoleSphere) {
  expect_furnace(ProfileKind::dipole, 1.5);
}
TEST(WhiteFurnace, NormalizedDiffusionSphere) {
  expect_furnace(ProfileKind::normalized_diffusion, 1.3);
}
TEST(WhiteFurnace, IndexMatchedSphere) {
  expect_furnace(ProfileKind::dipole, 1.0);
}

}  // namespace
}  // namespace opaline::test
