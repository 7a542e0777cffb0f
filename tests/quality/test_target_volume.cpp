// SPDX-License-Identifier: GPL-3.0-or-later
// --target-error of volume_diffusion: the promise against random walks.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "opaline/compare.h"
#include "quality/probe.h"
#include "quality/target_error.h"
#include "session/session_test.h"

namespace opaline::test {
namespace {

Scene lit(ShapeSource source, const Medium& medium) {
  Scene scene = single_shape(std::move(source), medium, 1);
  scene.lights = {point_light({20, 30, 60}, {1e4, 1e4, 1e4})};
  scene.camera.position = {0, 20, 45};
  scene.camera.field_of_view = 30;
  scene.film.resolution = {64, 64};
  scene.settings.method = Method::volume_diffusion;
  scene.settings.reenter = false;
  return scene;
}

Medium skin() {
  return {"skin", PhysicalMedium{{.032, .17, .48}, {.74, .88, 1.01}}, 1.3, {}};
}

Image walked(Scene scene, std::size_t cells, std::uint64_t seed) {
  scene.settings.method = Method::volume;
  scene.settings.until_error = .12;
  scene.settings.samples = cells;
  scene.settings.seed = seed;
  return cold_picture(scene);
}

/// Mean relative error of the diffuse light of the worst channel, as of a normal distribution of that rms, without the noise
/// of two pictures by walks, which know nothing of each other.
double measured(const Image& picture, const Image& a, const Image& b) {
  const Layer light = extract_layer(picture, "diffuse"), first = extract_layer(a, "diffuse"),
              second = extract_layer(b, "diffuse");
  const std::vector<std::uint8_t> seen = translucent_pixels(a);
  double worst = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0, count = 0, mean = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i] == 0) continue;
      mean += double(first.channels[c][i]);
      count += 1;
    }
    mean /= count;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const double x = double(light.channels[c][i]), y = double(first.channels[c][i]),
                   z = double(second.channels[c][i]);
      if (seen[i] != 0) sum += (x - y) * (x - z) / std::pow(std::max(.5 * (y + z), .2 * mean), 2);
    }
    worst = std::max(worst, std::sqrt(std::max(0., sum / count) * 2 * std::numbers::inv_pi));
  }
  return worst;
}

// Claim: pictures are within the target of random walks, be the target tight or wide, and take coarser cells for a wide
// one. Source: target_error.h. The walks' noise is taken out. Fails if: cells stay the coarsest
// that there are: the ball of skin is off by more then.
TEST(TargetVolume, IsKept) {
  struct Case {
    Scene scene;
    std::size_t cells;  // of the walks
    double target;
  };
  for (const auto& [scene, cells, target] : {Case{lit(SphereShape{{}, 12.5}, skin()), 150, .125},
                                             Case{lit(SlabShape{{}, 10, 10, 3}, marble()), 1500, .055}}) {
    const Image a = walked(scene, cells, 1), b = walked(scene, cells, 2);
    Session session;
    const TargetError chosen = reach_volume_error(session, scene, target);
    const double error = measured(session.render().image, a, b);
    RecordProperty("measured", std::to_string(error));
    SCOPED_TRACE(std::to_string(error) + " measured, predicted " + std::to_string(chosen.predicted) +
                 ", cells " + std::to_string(session.scene().settings.cell_size));
    EXPECT_TRUE(chosen.reached && chosen.sees_translucent);
    EXPECT_LE(chosen.predicted, target);
    EXPECT_LE(error, target);
    EXPECT_EQ(reach_volume_error(session, scene, .4).reached, true);
    EXPECT_EQ(session.scene().settings.cell_size, 3);
  }
}

// Claim: what the model cannot keep is not promised: the least that can be is, which is above the expected error, and
// cells are no finer than that needs. Source: target_error.h. Fails if: the model's error is left out.
TEST(TargetVolume, SaysTheLeast) {
  const Scene scene = lit(SphereShape{{}, 12}, marble());  // with the cells of its medium, not smaller ones
  Session session;
  const TargetError chosen = reach_volume_error(session, scene, .01);
  EXPECT_FALSE(chosen.reached);
  ASSERT_TRUE(chosen.model.has_value());
  EXPECT_GT(*chosen.model, *session.plan().groups[0].model.expected_error_of_diffusion);
  EXPECT_GT(chosen.promised, *chosen.model);
  EXPECT_LE(chosen.predicted, chosen.promised);
  EXPECT_GT(session.scene().settings.cell_size, 1);
}

// Claim: shadow rays are added until they change nothing that counts, where a light has an extent, and only there. Fails
// if: pictures of few and of many rays are the same, or delta lights count.
TEST(TargetVolume, SettlesTheLight) {
  Scene scene = two_balls();
  scene.settings.method = Method::volume_diffusion;
  scene.settings.light_samples = 1;
  Session session;
  reach_volume_error(session, scene, .06);
  EXPECT_GT(session.scene().settings.light_samples, 1);
  scene.lights.erase(scene.lights.begin() + 1);  // the panel
  reach_volume_error(session, scene, .06);
  EXPECT_EQ(session.scene().settings.light_samples, 1);
}

}  // namespace
}  // namespace opaline::test
