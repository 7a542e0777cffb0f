// SPDX-License-Identifier: GPL-3.0-or-later
// A stage that computes other numbers must have another version in its keys, or old caches pass for new.
#include "methods/hierarchical/hierarchical_state.h"
#include "methods/volume/volume_state.h"
#include "methods/volume_diffusion/volume_diffusion_state.h"
#include "stages/stage_keys.h"
#include "support/cache_test.h"
#include "support/scenes.h"

namespace opaline {
namespace {

using namespace test;

// Claim: cached samples, irradiance and octrees have not changed since their versions in
// src/stages/stage_keys.cpp and src/methods were last raised. Source: this box, computed without functions of a
// mathematical library. If it fails after an intended change: raise the version of that stage and put the new
// value here. Fails if: any constant of a stage is changed.
TEST(StageVersions, ComputeWhatTheyDid) {
  Scene scene = single_shape(BoxShape{{-10, -8, -6}, {10, 8, 6}}, marble(), 500);
  Shape blocker;
  blocker.source = BoxShape{{-4, 12, -4}, {4, 13, 4}};
  scene.shapes.push_back(blocker);
  scene.lights = {point_light({0, 40, 30}, {1, 2, 3})};
  scene.settings.bounces = 0;
  const Prepared box(scene);
  const Body& group = box.bodies[0];

  KeyBuilder samples("samples", 0), light("light", 0), tree("tree", 0);
  samples.add_array(std::span(group.surface.samples));
  light.add_array(std::span(group.transfers[0].weights));
  for (const OctreeNode& node : hierarchical_state(group).octree().nodes)  // without its padding
    tree.add(node.x).add(node.y).add(node.z).add(node.flux).add(node.center).add(node.half).add(node.spread);
  tree.add_array(std::span(hierarchical_state(group).octree().samples))
      .add(hierarchical_state(group).octree().flux_unit);
  EXPECT_EQ(hex(samples.key()), "2bde921ac9ab3e7ea7068780dc3773f4") << "raise kSamplesVersion";
  EXPECT_EQ(hex(light.key()), "d773558d8dda15dc22a0bd5371526867") << "raise kTransferVersion";
  EXPECT_EQ(hex(tree.key()), "5dcdc5ad9465e646a9e7beda01c9aba0") << "raise kTransmittedVersion";
}

Scene lit_ball(Method method) {
  Scene scene = single_shape(SphereShape{{0, 0, 0}, 10}, marble(), 300);
  scene.lights = {point_light({0, 40, 30}, {1, 2, 3})};
  scene.settings.method = method;
  return scene;
}

double mean_of(std::span<const RgbF> values) {
  double sum = 0;
  for (const RgbF& value : values) sum += double(value[0]) + 2 * double(value[1]) + 3 * double(value[2]);
  return sum / double(values.size());
}

// Claim: the same of the other stages that are kept, in which exponentials and instruction sets take part: their means are
// what they were, but for rounding. Tolerance: 1e-5, 1e-3 of what stops at a residual. If it fails and the
// change was meant: raise the version that is named, and put the new value here. Fails if: a stage computes other numbers.
TEST(StageVersions, ComputeWhatTheyDidButForRounding) {
  Scene scene = lit_ball(Method::hierarchical);
  scene.settings.evaluator = EvaluatorKind::surface_cache;
  const Prepared cached(scene);
  double exitance = 0;
  for (const SurfaceCache::Vertex& vertex : hierarchical_state(cached.bodies[0]).cache()->vertices)
    exitance += double(vertex.value.exitance[0]);
  EXPECT_NEAR(exitance / 3.0959120294, 1, 1e-5) << "raise kExitanceVersion";

  Shape wall;
  wall.source = QuadShape{{-20, -12, 20}, {40, 0, 0}, {0, 0, -40}};
  wall.reflectance = {.8, .4, .2};
  scene = lit_ball(Method::hierarchical);
  scene.shapes.push_back(wall);
  scene.settings.bounces = 1;
  EXPECT_NEAR(mean_of(hierarchical_state(Prepared(scene).bodies[0]).irradiance) / .00144611261, 1, 1e-5)
      << "raise the number of \"bounces\" in update_bounces.cpp";

  EXPECT_NEAR(mean_of(volume_diffusion_state(Prepared(lit_ball(Method::volume_diffusion)).bodies[0])
                          .direct.value.exitance) /
                  .00110990045,
              1, 1e-3)
      << "raise the numbers of \"diffusion\" in update_stages.cpp";

  scene = lit_ball(Method::volume);
  scene.settings.until_error = .3;
  EXPECT_NEAR(mean_of(volume_state(Prepared(scene).bodies[0]).exitance.value.exitance) / .00114146671, 1,
              1e-5)
      << "raise kWalksVersion";

  scene = lit_ball(Method::hierarchical);
  Session session;
  for (const double radius : {10., 13.}) {
    scene.shapes[0].source = SphereShape{{0, 0, radius - 10}, radius};
    session.edit(scene);
    session.prepare();
  }
  double places = 0;
  for (const SurfaceSample& sample : session.bodies()[0].surface.samples)
    places += double(sample.area) * double(dot(sample.centroid, Vec3f{1, 2, 3}));
  EXPECT_GT(session.work().samples_carried, 0u);
  EXPECT_NEAR(places / 19112.02055, 1, 1e-5) << "raise kCarriedVersion";
}

// Claim: the same of the profile that is tabulated by random walks.
TEST(LongStageVersions, ProfileComputesWhatItDid) {
  Medium medium = marble();
  medium.profile = ProfileKind::tabulated;
  double within = 0;
  for (const ChannelProfile& channel : make_diffuse_profile(medium).channels)
    for (const double r : {.1, 1.0, 5.0}) within += diffuse_reflectance_within(channel, r);
  EXPECT_NEAR(within / 3.25386519, 1, 1e-5) << "raise kWalkedProfileVersion";
}

}  // namespace
}  // namespace opaline
