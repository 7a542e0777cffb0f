// SPDX-License-Identifier: GPL-3.0-or-later
// The exitance is linear in the irradiance, each channel by itself.
#include "support/clouds.h"

namespace opaline {
namespace {

using namespace test;

struct SphereInAnyLight {
  Cloud cloud{SphereShape{{}, 5}, 5000};
  std::vector<Query> queries = Cloud(SphereShape{{}, 5}, 300, 3).queries();
  SplitKernel kernel = cloud.kernel(make_diffuse_profile(marble()));

  std::vector<Exitance> lit(const RgbF& factor, EvaluatorKind evaluator) const {
    const Octree octree = cloud.tree([&](const SurfaceSample& s) { return coloured_light(s) * factor; });
    return evaluated_by(evaluator, octree, kernel, queries, .1);
  }
};

// Claim: irradiance times 1e12 or 1e-30 gives exitance times that. Source: the sum is linear. Tolerance:
// 1e-5, float. Fails if: a flux below float's smallest number is flushed, or a threshold stands in W.
TEST(LightRange, IsLinear) {
  const SphereInAnyLight setup;
  for (const EvaluatorKind evaluator : kEvaluators) {
    const std::vector<Exitance> reference = setup.lit(RgbF(1), evaluator);
    for (const float k : {1e12f, 1e-12f, 1e-30f}) {
      const std::vector<Exitance> scaled = setup.lit(RgbF(k), evaluator);
      for (std::size_t i = 0; i < scaled.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(double(scaled[i].exitance[c]) / (double(k) * double(reference[i].exitance[c])), 1, 1e-5)
              << k << ", " << name_of(evaluator);
          EXPECT_NEAR(double(scaled[i].irradiance[c]), double(k) * double(reference[i].irradiance[c]),
                      1e-5 * double(k));
        }
    }
  }
}

// Claim: pure red irradiance gives exactly 0 in green and blue, and red does not depend on the other
// channels. Source: channels are independent. Tolerance: none for the zeros and for red in brute force; 1 %
// for red through the trees, which open a node for all channels when one asks. Fails if: one weight serves
// all channels.
TEST(LightRange, RedStaysRed) {
  const SphereInAnyLight setup;
  for (const EvaluatorKind evaluator : kEvaluators) {
    const std::vector<Exitance> white = setup.lit(RgbF(1), evaluator), red = setup.lit({1, 0, 0}, evaluator);
    for (std::size_t i = 0; i < red.size(); ++i) {
      EXPECT_NEAR(red[i].exitance.x / white[i].exitance.x, 1,
                  evaluator == EvaluatorKind::brute_force ? 0 : .01);
      EXPECT_GT(red[i].exitance.x, 0);
      EXPECT_EQ(red[i].exitance.y, 0);
      EXPECT_EQ(red[i].exitance.z, 0);
    }
  }
}

// Claim: no light gives exactly 0 everywhere. Source: linearity. Tolerance: none. Fails if: 0/0 in E's
// interpolation.
TEST(LightRange, NoLight) {
  const SphereInAnyLight setup;
  for (const EvaluatorKind evaluator : kEvaluators)
    for (const Exitance& e : setup.lit(RgbF(0), evaluator)) {
      EXPECT_EQ(e.exitance, RgbF(0));
      EXPECT_EQ(e.irradiance, RgbF(0));
    }
}

// Claim: one channel without coefficients stays exactly 0 and leaves the others' bits. Source: a peer's NaN
// picture. Tolerance: none but for the dual tree, .5 %: it opens a node for all channels when one asks. Fails
// if: a 0 mean free path spreads through a shared radius.
TEST(LightRange, EmptyChannel) {
  const SphereInAnyLight setup;
  const Octree octree = setup.cloud.tree(coloured_light);
  const SplitKernel part = setup.cloud.kernel(make_diffuse_profile(
      {"m", PhysicalMedium{{.0021, 0, .0071}, {2.19, 0, 3.00}}, 1.5, ProfileKind::dipole}));
  for (const EvaluatorKind evaluator : kEvaluators) {
    const auto run = [&](const SplitKernel& kernel) {
      return evaluated_by(evaluator, octree, kernel, setup.queries, .1);
    };
    const std::vector<Exitance> whole = run(setup.kernel), rest = run(part);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const double bar = evaluator == EvaluatorKind::dual_tree ? .005 : 0;
      EXPECT_NEAR(rest[i].exitance.x / whole[i].exitance.x, 1, bar) << name_of(evaluator);
      EXPECT_EQ(rest[i].exitance.y, 0);
      EXPECT_NEAR(rest[i].exitance.z / whole[i].exitance.z, 1, bar) << name_of(evaluator);
    }
  }
}

}  // namespace
}  // namespace opaline
