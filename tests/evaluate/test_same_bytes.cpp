// SPDX-License-Identifier: GPL-3.0-or-later
// Bits that must not move.
#include "support/clouds.h"

namespace opaline {
namespace {

using namespace test;

static_assert(sizeof(Exitance) == 36);

// Claim: positions times 8, areas times 64, coefficients divided by 8 give the same exitance, bit for bit,
// for both evaluators and profiles; also by 1/1024. Source: the project's scale test. Tolerance: none. Fails
// if: any length, area or squared distance meets a constant.
TEST(SameBytes, PowersOfTwoScale) {
  const Cloud cloud(TorusShape{{}, 10, 4}, 5000);
  const std::vector<Query> queries = Cloud(TorusShape{{}, 10, 4}, 300, 3).queries();
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion})
    for (const double k : {8., 1 / 1024.}) {
      const Rgb a{.0021, .0041, .7}, s{2.19, 2.62, 3.00};
      const auto run = [&](double scale, bool tree, bool split) {
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
        return tree ? classic(octree, kernel, places, .1) : brute_force(octree, kernel, places);
      };
      for (const bool tree : {false, true})
        for (const bool split : {true, false})
          EXPECT_TRUE(same_bytes(run(1, tree, split), run(k, tree, split)))
              << "scale " << k << " tree " << tree << " split " << split;
    }
}

// Claim: one and two threads give the same bytes, and so does asking in another order or one by one. Source:
// the contract. Tolerance: none. Fails if: a query's sum depends on its neighbours in a batch.
TEST(SameBytes, ThreadsAndBatches) {
  const Cloud cloud(SphereShape{{}, 10}, 10000);
  const std::vector<Query> queries = Cloud(SphereShape{{}, 10}, 1000, 3).queries();
  const Octree octree = cloud.tree(coloured_light);
  const SplitKernel kernel = cloud.kernel(make_diffuse_profile(marble()));
  for (const bool tree : {false, true}) {
    const auto run = [&](const std::vector<Query>& places) {
      return tree ? classic(octree, kernel, places, .1) : brute_force(octree, kernel, places);
    };
    const std::vector<Exitance> one = with_threads(1, [&] { return run(queries); });
    EXPECT_TRUE(same_bytes(with_threads(2, [&] { return run(queries); }), one));
    std::vector<Exitance> reversed = run(std::vector<Query>(queries.rbegin(), queries.rend()));
    std::reverse(reversed.begin(), reversed.end());
    EXPECT_TRUE(same_bytes(reversed, one));
    for (const std::size_t i : {std::size_t(0), std::size_t(17), queries.size() - 1}) {
      const Exitance alone = run({queries[i]}).at(0);
      EXPECT_EQ(alone.exitance, one[i].exitance) << i << " tree " << tree;
      EXPECT_EQ(alone.irradiance, one[i].irradiance) << i << " tree " << tree;
    }
  }
}

}  // namespace
}  // namespace opaline
