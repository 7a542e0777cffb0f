// SPDX-License-Identifier: GPL-3.0-or-later
// The classic traversal against the sum it approximates.
#include "support/clouds.h"

namespace opaline {
namespace {

using namespace test;

// Claim: the classic traversal's error against brute force falls with max_solid_angle, from 1 sr to float
// rounding, in every channel of a coloured, shadowed irradiance and for both profiles. Source: a bound on the
// size of what is taken as a point. Tolerance: the mean strictly monotone down to 2e-6, at most 1 % from .1
// sr on (3 % where half the surface is in shadow and errors count relative to the dark); the largest 3e-6
// relative at 1e-6 sr. Fails if: thousands of terms are summed in one float.
TEST(ClassicConverges, ToBruteForce) {
  const Cloud cloud(TorusShape{{}, 10, 4}, 20000);
  const std::vector<Query> queries = Cloud(TorusShape{{}, 10, 4}, 400, 3).queries();
  const Octree octree = cloud.tree(coloured_light);
  for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion}) {
    const DiffuseProfile profile =
        make_diffuse_profile({"m", PhysicalMedium{{.001, .01, .1}, {2, 3, 4}}, 1.5, kind});
    const SplitKernel kernel = cloud.kernel(profile);
    const std::vector<Exitance> exact = brute_force(octree, kernel, queries);
    for (std::size_t c = 0; c < 3; ++c) {
      double before = 1e9;
      std::printf("             %s, channel %zu:",
                  kind == ProfileKind::dipole ? "dipole" : "normalized diffusion", c);
      for (const double max_solid_angle : {1., .3, .1, .03, .01, 1e-3, 1e-6}) {
        const Difference d = difference(
            classic(octree, kernel, queries, max_solid_angle),
            [&](std::size_t i) { return exact[i].exitance[c]; }, c);
        std::printf(" %g sr %.2g (largest %.2g)", max_solid_angle, d.mean, d.largest);
        if (before > 2e-6) {
          EXPECT_LT(d.mean, before) << max_solid_angle;
        }
        before = d.mean;
        if (max_solid_angle <= .1) {
          EXPECT_LT(d.mean, c == 1 ? .03 : .01) << max_solid_angle;
        }
        if (max_solid_angle == 1e-6) {
          EXPECT_LE(d.largest, 3e-6);
        }
      }
      std::printf("\n");
    }
  }
}

// Claim: however large max_solid_angle, no node that reaches into h is taken whole: the irradiance
// interpolated from the samples within h is brute force's. Source: the header. Tolerance: 1e-6, rounding.
// Fails if: the test for h is left out, or measures to the node's centre instead of its box.
TEST(ClassicConverges, NearFieldIsAlwaysSampleBySample) {
  const Cloud cloud(TorusShape{{}, 10, 4}, 20000);
  const std::vector<Query> queries = Cloud(TorusShape{{}, 10, 4}, 400, 3).queries();
  const Octree octree = cloud.tree(coloured_light);
  const SplitKernel kernel = cloud.kernel(make_diffuse_profile(marble()));
  const std::vector<Exitance> exact = brute_force(octree, kernel, queries);
  for (const double max_solid_angle : {1., 1e3, 1e9}) {
    const std::vector<Exitance> values = classic(octree, kernel, queries, max_solid_angle);
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(values[i].irradiance[c], exact[i].irradiance[c], 1e-6) << max_solid_angle << " " << i;
  }
}

}  // namespace
}  // namespace opaline
