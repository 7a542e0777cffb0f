// SPDX-License-Identifier: GPL-3.0-or-later
// No shadow may be missed: a light's entry in the cache would be taken where it is another.
#include "stages/stage_keys.h"
#include "support/cache_test.h"
#include "support/scenes.h"

namespace opaline {
namespace {

using namespace test;

double draw(std::uint64_t i, std::uint64_t k, double low, double high) {
  return low + (high - low) * unit_double(hash_bits(11 + k, i));
}
Vec3d place(std::uint64_t i, std::uint64_t k, double size) {
  return {draw(i, 3 * k, -size, size), draw(i, 3 * k + 1, -size, size), draw(i, 3 * k + 2, -size, size)};
}

std::vector<LightSource> sources(std::uint64_t i) {
  const Vec3d at = place(i, 1, 90);
  return {PointLight{at, Rgb(1)}, DirectionalLight{normalized(at), Rgb(1)},
          SphereLight{at, draw(i, 20, 1, 20), Rgb(1)},
          QuadLight{at, place(i, 2, 20), place(i, 3, 20), Rgb(1)}, Surroundings{Rgb(1)}};
}

// Claim: where may_shadow says no, the light that enters the group is the same with the mesh and without, bit
// for bit; and it does say no where there is nothing to shadow. Source: stage_keys.h. 300 random boxes and
// lights of every kind. Fails if: a mesh's ball is a tenth of its size, or a sun's direction is turned round.
TEST(MayShadow, MissesNothing) {
  std::size_t said_no = 0, shadowed = 0;
  for (std::uint64_t i = 0; i < 60; ++i)
    for (const LightSource& source : sources(i)) {
      Scene scene = single_shape(BoxShape{{-10, -5, -5}, {10, 5, 5}}, marble(), 300);
      scene.lights = {{"light", source}};
      scene.settings.light_samples = 8;
      Shape blocker;
      const Vec3d at =
          (i % 2 == 0 ? 1 : -1) * (draw(i, 30, .3, .9) * place(i, 1, 90)) + place(i, 5, 40);  // near the way
      blocker.source = BoxShape{at - Vec3d{15, 10, 2}, at + Vec3d{15, 10, 2}};
      scene.shapes.push_back(blocker);
      const Prepared with(scene);
      // The same place in the world without: the blocker where nothing sees it would move the middle.
      Scene bare = scene;
      World world = with.world;
      for (Vec3d& p : world.meshes[1].positions) p = Vec3d{1e6, 1e6, 1e6} + p * 1e-9;
      const RayScene rays(world);
      const PrecomputeInput input{bare, world, rays, with.plan, nullptr};
      const auto without = trace_transfers(input, 0, with.bodies[0].boundary, with.bodies[0].surface.samples,
                                           recentred_lights(bare, world));
      const bool same = without[0].weights == with.bodies[0].transfers[0].weights;
      const bool may = may_shadow(mesh_keys(with.world), 1, with.plan.groups[0],
                                  recentred_lights(scene, with.world)[0], with.world.unit);
      ASSERT_TRUE(may || same) << i << " light kind " << source.index();
      said_no += !may;
      shadowed += !same;
    }
  EXPECT_GT(said_no, 60u);
  EXPECT_GT(shadowed, 40u);
}

}  // namespace
}  // namespace opaline
