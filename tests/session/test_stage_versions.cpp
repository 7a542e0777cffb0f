// SPDX-License-Identifier: GPL-3.0-or-later
// A stage that computes other numbers must have another version in its keys, or old caches pass for new.
#include "opaline/session/stage_keys.h"
#include "support/cache_test.h"
#include "support/scenes.h"

namespace opaline {
namespace {

using namespace test;

// Claim: samples, light and trees, which the cache keeps, are what they were when their versions in
// src/session/stage_keys.cpp were last raised. Source: this box, in which no function of a mathematical library
// takes part. If it fails and the change was meant: raise the versions of that stage and put the new value
// here. Fails if: any constant of a stage is changed.
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
  for (const OctreeNode& node : group.octree.nodes)  // without its padding
    tree.add(node.x).add(node.y).add(node.z).add(node.flux).add(node.center).add(node.half).add(node.spread);
  tree.add_array(std::span(group.octree.samples)).add(group.octree.flux_unit);
  EXPECT_EQ(hex(samples.key()), "2bde921ac9ab3e7ea7068780dc3773f4") << "raise kSamplesVersion";
  EXPECT_EQ(hex(light.key()), "d773558d8dda15dc22a0bd5371526867") << "raise kTransferVersion";
  EXPECT_EQ(hex(tree.key()), "5dcdc5ad9465e646a9e7beda01c9aba0") << "raise kOctreeVersion";
}

}  // namespace
}  // namespace opaline
