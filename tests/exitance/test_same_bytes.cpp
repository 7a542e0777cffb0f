// SPDX-License-Identifier: GPL-3.0-or-later
// Bits that must not move.
#include "support/clouds.h"

namespace opaline {
namespace {

using namespace test;

static_assert(sizeof(Exitance) == 48);

// Claim: positions times 8, areas times 64, coefficients divided by 8 give the same exitance, bit for bit,
// for every evaluator and both profiles; also by 1/1024. Source: the project's scale test. Tolerance: none.
// Fails if: any length, area or squared distance meets a constant.
TEST(SameBytes, PowersOfTwoScale) {
  const Cloud cloud(TorusShape{{}, 10, 4}, 5000);
  const std::vector<Query> queries = Cloud(TorusShape{{}, 10, 4}, 300, 3).queries();
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion})
    for (const double k : {8., 1 / 1024.}) {
      const Rgb a{.0021, .0041, .7}, s{2.19, 2.62, 3.00};
      const auto run = [&](double scale, EvaluatorKind evaluator, bool split) {
        std::vector<FluxSample> samples = cloud.flux(coloured_light);
        for (FluxSample& sample : samples) {
          sample.position *= float(scale);
          sample.area *= float(scale * scale);
        }
        std::vector<Query> places = queries;
        for (Query& q : places) q.position *= float(scale);
        const DiffuseProfile profile =
            make_diffuse_profile({"m", PhysicalMedium{a / scale, s / scale}, 1.5, kind});
        const SplitKernel kernel =
            make_split_kernel(profile, cloud.surface.spacing() * scale, cloud.world.diagonal * scale, split);
        const Octree octree = build_octree(samples);
        return evaluated_by(evaluator, octree, kernel, places, .1);
      };
      for (const EvaluatorKind evaluator : kEvaluators)
        for (const bool split : {true, false})
          EXPECT_TRUE(same_bytes(run(1, evaluator, split), run(k, evaluator, split)))
              << "scale " << k << ", " << name_of(evaluator) << ", split " << split;
    }
}

/// A coloured sphere of 10,000 samples and 1,000 places on it.
struct LitSphere {
  Cloud cloud{SphereShape{{}, 10}, 10000};
  std::vector<Query> queries = Cloud(SphereShape{{}, 10}, 1000, 3).queries();
  Octree octree = cloud.tree(coloured_light);
  SplitKernel kernel = cloud.kernel(make_diffuse_profile(marble()));

  std::vector<Exitance> run(EvaluatorKind evaluator, const std::vector<Query>& places) const {
    return evaluated_by(evaluator, octree, kernel, places, .1);
  }
};

// Claim: one and two threads give the same bytes, and so do two runs. Source: the contract. Tolerance: none.
// Fails if: chunks are cut by the number of threads, or a group reads what another has left.
TEST(SameBytes, Threads) {
  const LitSphere lit;
  for (const EvaluatorKind evaluator : kEvaluators) {
    const auto run = [&] { return lit.run(evaluator, lit.queries); };
    const std::vector<Exitance> one = with_threads(1, run);
    for (int again = 0; again < 3; ++again)
      EXPECT_TRUE(same_bytes(with_threads(2, run), one)) << name_of(evaluator);
  }
}

// Claim: brute force and the classic traversal give the same bytes in another order and one by one (the dual
// tree, which takes queries together, gives the tolerance: test_dual_tree_company). Source: the contract.
// Tolerance: none. Fails if: a query's sum depends on its neighbours in a batch.
TEST(SameBytes, Batches) {
  const LitSphere lit;
  for (const EvaluatorKind evaluator : {EvaluatorKind::brute_force, EvaluatorKind::classic}) {
    const std::vector<Exitance> one = lit.run(evaluator, lit.queries);
    std::vector<Exitance> reversed = lit.run(evaluator, {lit.queries.rbegin(), lit.queries.rend()});
    std::reverse(reversed.begin(), reversed.end());
    EXPECT_TRUE(same_bytes(reversed, one));
    for (const std::size_t i : {std::size_t(0), std::size_t(17), lit.queries.size() - 1}) {
      const Exitance alone = lit.run(evaluator, {lit.queries[i]}).at(0);
      EXPECT_EQ(alone.exitance, one[i].exitance) << i << ", " << name_of(evaluator);
      EXPECT_EQ(alone.irradiance, one[i].irradiance) << i << ", " << name_of(evaluator);
    }
  }
}

}  // namespace
}  // namespace opaline
