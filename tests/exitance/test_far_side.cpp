// SPDX-License-Identifier: GPL-3.0-or-later
// The multipole's two sides in sums over the tree.
#include "support/clouds.h"
#include "support/quadrature.h"

namespace opaline {
namespace {

using namespace test;

constexpr double kThickness = 1;

DiffuseProfile multipole(double mean_free_path, double absorbed) {
  Medium medium = grey_medium(mean_free_path, absorbed, 1.3, ProfileKind::multipole);
  medium.thickness = kThickness;
  return make_diffuse_profile(medium);
}

const Cloud& plate() {
  static const Cloud cloud(SlabShape{{}, 40, 40, kThickness}, 30000);
  return cloud;
}

std::array<double, 4> reach_of(const Vec3f& p) {
  const double x = double(p.x), z = double(p.z);
  return {20 - x, 20 - z, 20 + x, 20 + z};
}

double from_own_face(const ChannelProfile& profile, const Vec3f& p) {
  return rectangle_integral([&](double r) { return diffuse_reflectance_within(profile, r); }, reach_of(p));
}
double from_far_face(const ChannelProfile& profile, const Vec3f& p) {
  return rectangle_integral([&](double r) { return diffuse_transmittance_within(profile, r, kThickness); },
                            reach_of(p));
}

Octree with_cones(Octree tree) {
  bound_normals(tree);
  return tree;
}

// Claim: under E = 1 on both faces of a plate the exitance is the reflected side of its own face and the transmitted
// side of the other, for mean free paths of .1 to 2 thicknesses, by every evaluator. Source: polar quadrature.
// Tolerance: mean 1 % at 30,000 samples (spacing .33), any place 4 %. Fails if: R_d of the far face is not taken away,
// T is asked for at the straight distance, or the reach is a tenth.
TEST(FarSide, BothFacesOfAPlate) {
  const Octree octree = with_cones(plate().tree(RgbF(1)));
  for (const double mean_free_path : {.1, .5, 2.}) {
    const DiffuseProfile profile = multipole(mean_free_path, .02);
    const SplitKernel kernel = plate().kernel(profile);
    ASSERT_NE(kernel.far_side, nullptr);
    std::vector<double> reference;
    for (const Query& q : places_on_plate())
      reference.push_back(from_own_face(profile.channels[0], q.position) +
                          from_far_face(profile.channels[0], q.position));
    for (const EvaluatorKind evaluator : kEvaluators) {
      const Difference d = difference(evaluated_by(evaluator, octree, kernel, places_on_plate(), .01),
                                      [&](std::size_t i) { return reference[i]; });
      const std::string name = std::string(name_of(evaluator)) + ", " + std::to_string(mean_free_path);
      report(name + ", mean %", 100 * d.mean);
      EXPECT_LT(d.mean, .01) << name;
      EXPECT_LT(d.largest, .04) << name;
    }
  }
}

// Claim: lit from behind alone the front shows the transmitted side. Source: the same. Tolerance: 2 % mean. Fails if:
// sides are told by anything but the normals.
TEST(FarSide, FromBehind) {
  const Octree octree =
      with_cones(plate().tree([](const SurfaceSample& s) { return RgbF(s.normal.y < -.5f ? 1.f : 0.f); }));
  std::vector<Query> front;
  for (const Query& q : places_on_plate())
    if (q.normal.y > 0) front.push_back(q);
  for (const double mean_free_path : {.3, 1., 3.}) {
    const DiffuseProfile profile = multipole(mean_free_path, .02);
    const SplitKernel kernel = plate().kernel(profile);
    std::vector<double> reference;
    for (const Query& q : front) reference.push_back(from_far_face(profile.channels[0], q.position));
    for (const EvaluatorKind evaluator : {EvaluatorKind::brute_force, EvaluatorKind::dual_tree}) {
      const Difference d = difference(evaluated_by(evaluator, octree, kernel, front, .01),
                                      [&](std::size_t i) { return reference[i]; });
      report(std::string(name_of(evaluator)) + ", mean %", 100 * d.mean);
      EXPECT_LT(d.mean, .02) << mean_free_path;
    }
  }
}

// Claim: nodes as points change the sum by little: with the bounds of their normals and without, which takes every
// sample. Source: the contract. Tolerance: 2e-3 of the exitance. Fails if: a node that straddles the rim counts as of
// another sheet.
TEST(FarSide, NodesStandForTheirSamples) {
  const Octree bounded = with_cones(plate().tree(coloured_light)), bare = plate().tree(coloured_light);
  const SplitKernel kernel = plate().kernel(multipole(.5, .001));
  std::vector<Query> queries = places_on_plate();
  queries.push_back({{20, 0, 3}, {1, 0, 0}});
  queries.push_back({{19.9f, .5f, 19.9f}, normalized(Vec3f{1, 1, 1})});
  const auto a = brute_force(bounded, kernel, queries), b = brute_force(bare, kernel, queries);
  for (std::size_t i = 0; i < queries.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(a[i].exitance[c], b[i].exitance[c], 2e-3f * b[i].exitance[c]) << i << " " << c;
}

// Claim: cones hold all normals of their node, and on a plate nodes of one face have narrow ones. Source: definition.
// Fails if: the sine is of the half angle.
TEST(FarSide, ConesHoldTheNormals) {
  const Cloud ball(SphereShape{{}, 5}, 3000);
  const Octree tree = with_cones(ball.tree(RgbF(1)));
  ASSERT_EQ(tree.normal_cones.size(), tree.nodes.size());
  std::size_t narrow = 0;
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const NormalCone& cone = tree.normal_cones[n];
    if (cone.cosine == 0) continue;
    ++narrow;
    EXPECT_NEAR(cone.cosine * cone.cosine + cone.sine * cone.sine, 1, 1e-5f);
    for (std::uint32_t i = tree.nodes[n].first; i < tree.nodes[n].first + tree.nodes[n].count; ++i)
      EXPECT_GE(dot(tree.normals[i], cone.axis), cone.cosine) << n;
  }
  EXPECT_GT(narrow, tree.nodes.size() / 2);
}

}  // namespace
}  // namespace opaline
