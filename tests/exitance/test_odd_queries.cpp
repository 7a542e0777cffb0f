// SPDX-License-Identifier: GPL-3.0-or-later
// Queries where no renderer would ask.
#include "support/clouds.h"

namespace opaline {
namespace {

using namespace test;

// Claim: queries far outside, in the middle of the volume, exactly on a sample, on faces and corners of the
// tree's boxes give finite values >= 0, every evaluator, both profiles, with and without the split (where
// normalized diffusion's R_d(0) is infinite); far away they are 0, not NaN, even where the squared distance
// overflows. Source: the contract. Tolerance: none. Fails if: r = 0 divides, or E's normalisation divides 0
// by 0.
TEST(OddQueries, AreFinite) {
  const Cloud cloud(SphereShape{{}, 5}, 3000);
  const Octree octree = cloud.tree(coloured_light);
  std::vector<Query> queries;
  const auto ask = [&](const Vec3f& p) { queries.push_back({p, {0, 1, 0}}); };
  for (const float far : {1e3f, 1e6f, 1e15f, 1e25f, 3e38f}) {
    ask({far, 0, 0});
    ask({-far, far, far});
  }
  const std::size_t far_ones = queries.size();
  ask({0, 0, 0});
  ask({1, 2, 3});
  for (std::size_t i = 0; i < octree.nodes.size(); i += 7) {
    const OctreeNode& node = octree.nodes[i];
    ask(node.center);
    ask(node.center + node.half);
    ask(node.center - Vec3f{node.half.x, 0, 0});
    ask(node.center + Vec3f{0, 0, node.half.z});
    ask({node.x[0], node.y[0], node.z[0]});
  }
  for (std::size_t i = 0; i < octree.samples.size(); i += 10) {
    const TreeSample& s = octree.samples[i];
    queries.push_back({{s.x, s.y, s.z}, octree.normals[i]});
    queries.push_back({{s.x, s.y, s.z}, -octree.normals[i]});
  }
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion})
    for (const double mean_free_path : {0., 1e-3, .3, 500.})
      for (const bool split : {true, false}) {
        const Medium medium{"m", ArtistMedium{{.1, .8, 1}, Rgb(mean_free_path), 0}, 1.5, kind};
        const SplitKernel kernel = cloud.kernel(make_diffuse_profile(medium), split);
        EXPECT_EQ(kernel.split, split);
        for (const EvaluatorKind evaluator : kEvaluators) {
          const std::vector<Exitance> values = evaluated_by(evaluator, octree, kernel, queries, .3);
          ASSERT_EQ(values.size(), queries.size());
          for (std::size_t i = 0; i < values.size(); ++i) {
            ASSERT_TRUE(finite_and_not_negative(values[i]))
                << i << " split " << split << ", " << name_of(evaluator) << ", mean free path "
                << mean_free_path << ": " << values[i].exitance.x << " " << values[i].exitance.y << " "
                << values[i].exitance.z << ", " << values[i].irradiance.x;
            // The dual tree's table still holds a power law a metre off.
            if (i < far_ones && (evaluator != EvaluatorKind::dual_tree || i >= 2)) {
              ASSERT_EQ(values[i].exitance, RgbF(0)) << i;
            }
          }
        }
      }
}

// Claim: a query exactly on a sample differs little from one a hundredth of a spacing beside it. Source: the
// split kernel's far part vanishes like r^3 there. Tolerance: .2 %. Fails if: the sample at r = 0 is left out
// or counted with R_d(0).
TEST(OddQueries, OnASampleIsNothingSpecial) {
  const Cloud cloud(floor_quad(5), 10000);
  std::vector<Query> on, beside;
  for (const SurfaceSample& s : cloud.surface.samples)
    if (std::max(std::abs(s.position.x), std::abs(s.position.z)) < 4) {
      on.push_back({s.position, s.normal});
      beside.push_back({s.position + Vec3f{float(.01 * cloud.surface.spacing()), 0, 0}, s.normal});
    }
  ASSERT_GT(on.size(), 4000u);
  on.resize(500);
  beside.resize(500);
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion}) {
    const SplitKernel kernel = cloud.kernel(make_diffuse_profile(grey_medium(.05, .01, 1.3, kind)));
    const Octree octree = cloud.tree(RgbF(1));
    for (const EvaluatorKind evaluator : kEvaluators) {
      const auto run = [&](const std::vector<Query>& places) {
        return evaluated_by(evaluator, octree, kernel, places, .003, .0005);
      };
      const std::vector<Exitance> reference = run(beside);
      EXPECT_LT(difference(run(on), [&](std::size_t i) { return reference[i].exitance.x; }).largest, .002)
          << name_of(evaluator);
    }
  }
}

// Claim: no samples give zeros, no queries give nothing. Source: the contract. Tolerance: none. Fails if: the
// root is read unasked.
TEST(OddQueries, NothingInNothingOut) {
  const Octree empty = build_octree({}), one = build_octree(std::vector<FluxSample>(1));
  const DiffuseProfile profile = make_diffuse_profile(marble());
  const SplitKernel kernel = make_split_kernel(profile, .1, 10, true);
  for (const EvaluatorKind evaluator : kEvaluators) {
    const std::vector<Query> queries(10);
    for (const Exitance& e : evaluated_by(evaluator, empty, kernel, queries, .3)) {
      EXPECT_EQ(e.exitance, RgbF(0));
      EXPECT_EQ(e.irradiance, RgbF(0));
    }
    EXPECT_TRUE(evaluated_by(evaluator, empty, kernel, {}, .3).empty());
    EXPECT_TRUE(evaluated_by(evaluator, one, kernel, {}, .3).empty());
  }
}

// Claim: N samples at one place, 1, 8 and 9 samples sum right: brute force and the tree agree, and with the
// split off a far query sees the whole flux times R_d. Source: definition. Tolerance: 3e-6, rounding and the
// table. Fails if: a single leaf at the root is skipped.
TEST(OddQueries, FewOrCoincidentSamples) {
  const DiffuseProfile profile = make_diffuse_profile(grey_medium(1, .1, 1.3));
  const SplitKernel kernel = make_split_kernel(profile, .1, 100, false);
  for (const std::size_t n : {1u, 8u, 9u, 5000u}) {
    std::vector<FluxSample> samples(n, FluxSample{{1, 2, 3}, .01f, {1, 2, 3}, {0, 1, 0}});
    const Octree octree = build_octree(samples);
    const std::vector<Query> queries = {{{4, 2, 3}, {0, 1, 0}}};
    const double expected = double(n) * .01 * diffuse_reflectance_profile(profile.channels[0], 3);
    for (const Exitance& e : {brute_force(octree, kernel, queries)[0], classic(octree, kernel, queries, 1)[0],
                              classic(octree, kernel, queries, 1e-9)[0]})
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(double(e.exitance[c]) / (expected * double(c + 1)), 1, 3e-6) << n << " " << c;
  }
}

}  // namespace
}  // namespace opaline
