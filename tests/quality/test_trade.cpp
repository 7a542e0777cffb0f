// SPDX-License-Identifier: GPL-3.0-or-later
// The trade of a scene: what each point says of error and time, against pictures that are made with its settings.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/stopwatch.h"
#include "quality/one_body.h"
#include "quality/probe.h"
#include "quality/trade.h"

namespace opaline::test {
namespace {

Scene torus_scene() {
  Scene scene = marble_torus(96);
  scene.settings.samples = 4000;
  return scene;
}

Image fine_picture_of(Scene scene) {
  scene.settings.samples = 150000;
  scene.settings.seed = 77;
  scene.settings.tolerance = 5e-4;
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  return cold_picture(scene);
}

std::vector<TradePoint> trade_of(const Scene& scene) {
  Session session;
  std::vector<TradePoint> points;
  try_trade(session, scene, [&](const TradePoint& point) { points.push_back(point); });
  return points;
}

// Claim: the error of each point is within a factor 2.5 of what a picture with its settings measures against 150k
// samples of another seed (TargetError's factor), that of lambert within 10 %; errors fall from point to point, the
// scene's own settings are one of them, and a picture of four times the samples is not said to be cheaper than one of a
// sixteenth. Fails if: a point's picture is made of another point's samples, or lambert is compared with the first.
TEST(Trade, ErrorsAreMeasuredOnes) {
  const Scene scene = torus_scene();
  const Image truth = fine_picture_of(scene);
  const std::vector<TradePoint> points = trade_of(scene);
  ASSERT_EQ(points.size(), 7u);  // a sixteenth of 4000 samples is too few
  for (std::size_t i = 0; i < points.size(); ++i) {
    Scene taken = scene;
    set_point(taken.settings, points[i]);
    const double measured = probe_difference(cold_picture(taken), truth);
    const bool is_lambert = points[i].method == Method::lambert;
    SCOPED_TRACE(std::to_string(points[i].all_samples) + " samples, error " +
                 std::to_string(points[i].error) + ", measured " + std::to_string(measured) + ", s " +
                 std::to_string(points[i].seconds));
    EXPECT_EQ(is_lambert, i == 6);
    EXPECT_NEAR(points[i].error / measured, 1, is_lambert ? .1 : 1.5);
    EXPECT_GT(points[i].error / measured, .4);
    EXPECT_GT(points[i].seconds, 0);
    EXPECT_EQ(points[i].is_given, i == 3);
    if (i > 0 && !is_lambert) {
      EXPECT_LT(points[i].error, points[i - 1].error);
    }
  }
  EXPECT_EQ(points[3].samples, scene.settings.samples);
  EXPECT_GT(points[5].seconds, points[0].seconds);
}

// Claim: without settings.samples the points are spacings, in which all groups have samples; a scene that shows nothing
// translucent has no points.
TEST(Trade, SpacingsAndNothing) {
  Scene scene = two_balls();
  scene.settings.samples.reset();
  scene.settings.sample_spacing = 1;
  const std::vector<TradePoint> points = trade_of(scene);
  ASSERT_GT(points.size(), 3u);
  for (const TradePoint& point : points)
    EXPECT_EQ(point.sample_spacing.has_value(), point.method == Method::hierarchical);
  scene.camera.look_at = {0, 100, 1000};
  EXPECT_TRUE(trade_of(scene).empty());
}

}  // namespace
}  // namespace opaline::test
