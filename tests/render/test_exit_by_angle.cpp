// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture shows of light that leaves at an angle.
#include <gtest/gtest.h>

#include <cmath>

#include "session/session_records.h"
#include "support/scenes.h"
#include "transport/fresnel.h"
#include "transport/half_space.h"
#include "transport/smooth_boundary.h"

namespace opaline::test {
namespace {

// Claim: in even light a ball of an absorbing medium, large beside it, has the radiance by angle of a half space: more at its
// rim than in the middle. Source: reciprocity, and HalfSpace for what comes back of light that enters at an angle.
// Tolerance: 1.5 % rms over the pixels of the ratio to that, its mean taken out, which is the ball's shape (measured 1.1;
// 5.3 by Ft alone). Fails if: light leaves as the boundary lets it.
TEST(ExitByAngle, BallInEvenLight) {
  constexpr double kEta = 1.3, kAbsorbed = .32;
  Scene scene = single_shape(SphereShape{{}, 15}, grey_medium(1, kAbsorbed, kEta), 500);
  scene.lights = {{"all around", Surroundings{Rgb(1.0)}}};
  scene.film.resolution = {48, 48};
  scene.camera.position = {0, 0, 120};
  scene.camera.field_of_view = 16;
  scene.settings.method = Method::volume_diffusion;
  const Image image = Prepared(scene).picture();
  const HalfSpace half_space(kAbsorbed, kEta);
  std::vector<double> ratios;
  double mean = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      if (channel(image, x, y, "A") < 1) continue;
      const Vec3d position{channel(image, x, y, "P.X"), channel(image, x, y, "P.Y"),
                           channel(image, x, y, "P.Z")},
          normal{channel(image, x, y, "N.X"), channel(image, x, y, "N.Y"), channel(image, x, y, "N.Z")};
      const double cosine = std::abs(dot(normalized(scene.camera.position - position), normal));
      const double expected =
          fresnel_transmittance(cosine, kEta) * half_space.share(refracted_cosine(cosine, 1 / kEta));
      ratios.push_back(channel(image, x, y, "diffuse.G") / expected);
      mean += ratios.back();
    }
  ASSERT_GT(ratios.size(), 500u);
  mean /= double(ratios.size());
  double square = 0;
  for (const double ratio : ratios) square += std::pow(ratio / mean - 1, 2);
  EXPECT_LT(std::sqrt(square / double(ratios.size())), .015);
}

}  // namespace
}  // namespace opaline::test
