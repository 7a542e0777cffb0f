// SPDX-License-Identifier: GPL-3.0-or-later
// Light that crosses a thin slab.
#include "support/clouds.h"
#include "support/quadrature.h"

namespace opaline {
namespace {

using namespace test;

/// Both faces of a 40 x 40 x 1 plate under E = 1 at the places; the rim, 15 mm or more away, gives below
/// 1e-5.
double expected_on_slab(const ChannelProfile& profile, const Vec3f& p) {
  const auto within = [&](double r) { return diffuse_reflectance_within(profile, r); };
  const double x = double(p.x), z = double(p.z);
  const std::array<double, 4> reach = {20 - x, 20 - z, 20 + x, 20 + z};
  return rectangle_integral(within, reach) + rectangle_integral(within, reach, 1);
}

// Claim: under E = 1 on both faces of a plate 1 mm thick each face's exitance is its own plus 1 -
// CDF(thickness) of the total from the far one, for mean free paths of .1, .5 and 2 mm. Source: polar
// quadrature of both faces. Tolerance: mean 1 % at 30,000 samples (spacing .33), any place 4 %. Fails if:
// samples of the far face are left out (by normals, or because h takes them for near: 45 % at 2 mm).
TEST(ThinSlab, FarFaceAdds) {
  const Cloud cloud(SlabShape{{}, 40, 40, 1}, 30000);
  const Octree octree = cloud.tree(RgbF(1));
  for (const double mean_free_path : {.1, .5, 2.}) {
    const DiffuseProfile profile = make_diffuse_profile(grey_medium(mean_free_path, .05, 1.3));
    const SplitKernel kernel = cloud.kernel(profile);
    for (const EvaluatorKind evaluator : {EvaluatorKind::brute_force, EvaluatorKind::dual_tree}) {
      const Difference d =
          difference(evaluated_by(evaluator, octree, kernel, places_on_plate(), .01), [&](std::size_t i) {
            return expected_on_slab(profile.channels[0], places_on_plate()[i].position);
          });
      const std::string name =
          name_of(evaluator) + std::string(", mean free path ") + std::to_string(mean_free_path);
      report(name + ", bias %", 100 * d.bias);
      report(name + ", mean %", 100 * d.mean);
      report(name + ", largest %", 100 * d.largest);
      EXPECT_LT(d.mean, .01) << name;
      EXPECT_LT(d.largest, .04) << name;
    }
  }
}

// Claim: lit from behind only, the front shows exactly the far face's share. Source: the same. Tolerance: 2 %
// mean. The irradiance interpolated at the front must be the front's: 0. Fails if: near irradiance is taken
// through the plate.
TEST(ThinSlab, FromBehind) {
  const Cloud cloud(SlabShape{{}, 40, 40, .5}, 30000);
  const Octree octree =
      cloud.tree([](const SurfaceSample& s) { return RgbF(s.normal.y < -.5f ? 1.f : 0.f); });
  std::vector<Query> front;
  for (Query q : places_on_plate()) {
    q.position.y = .25f;
    q.normal = {0, 1, 0};
    front.push_back(q);
  }
  const DiffuseProfile profile = make_diffuse_profile(grey_medium(.3, .05, 1.3));
  for (const EvaluatorKind evaluator : {EvaluatorKind::brute_force, EvaluatorKind::dual_tree}) {
    const std::vector<Exitance> values = evaluated_by(evaluator, octree, cloud.kernel(profile), front, .01);
    for (const Exitance& e : values) ASSERT_LT(e.irradiance.x, 1e-3f);
    const Difference d = difference(values, [&](std::size_t i) {
      const double x = double(front[i].position.x), z = double(front[i].position.z);
      return rectangle_integral([&](double r) { return diffuse_reflectance_within(profile.channels[0], r); },
                                {20 - x, 20 - z, 20 + x, 20 + z}, .5);
    });
    report(name_of(evaluator) + std::string(", from behind, bias %"), 100 * d.bias);
    report(name_of(evaluator) + std::string(", from behind, largest %"), 100 * d.largest);
    EXPECT_LT(d.mean, .02) << name_of(evaluator);
  }
}

// Claim: 30,000 samples agree with 300,000. Source: convergence. Tolerance: 2 % mean. Fails if: the answer
// depends on the spacing, as when h or the near part is off.
TEST(ThinSlab, ConvergesWithSamples) {
  const DiffuseProfile profile = make_diffuse_profile(grey_medium(.5, .05, 1.3));
  const auto run = [&](std::size_t count) {
    const Cloud cloud(SlabShape{{}, 40, 40, 1}, count);
    return brute_force(cloud.tree(RgbF(1)), cloud.kernel(profile), places_on_plate());
  };
  const std::vector<Exitance> many = run(300000);
  const Difference d = difference(run(30000), [&](std::size_t i) { return many[i].exitance.x; });
  report("30k against 300k samples, mean %", 100 * d.mean);
  report("30k against 300k samples, largest %", 100 * d.largest);
  EXPECT_LT(d.mean, .02);
}

}  // namespace
}  // namespace opaline
