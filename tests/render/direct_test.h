// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of `direct` share: a scene ready for it, and runs of it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/random.h"
#include "methods/direct/direct.h"
#include "methods/direct/direct_exitance.h"
#include "methods/direct/entry_sampler.h"
#include "plan/make_plan.h"
#include "support/clouds.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace opaline::test {

inline constexpr EntryStrategy kStrategies[] = {EntryStrategy::disc_axes, EntryStrategy::chords};

inline std::string name_of(ProfileKind kind, EntryStrategy strategy) {
  return std::string(kind == ProfileKind::dipole ? "dipole" : "normalized diffusion") +
         (strategy == EntryStrategy::disc_axes ? ", disc_axes" : ", chords");
}

inline SurfacePoint point_at(const Vec3d& position, const Vec3d& normal) {
  SurfacePoint p;
  p.position = Vec3f(position);
  p.normal = p.geometric = Vec3f(normal);
  return p;
}

/// Independent random numbers of sample i.
inline EntryRandom random_of(std::uint64_t i, std::uint64_t seed = 0) {
  EntryRandom random{{}, hash_bits(seed + 9, i)};
  for (std::size_t d = 0; d < 4; ++d) random.stratified[d] = unit_double(hash_bits(seed + d + 1, i));
  return random;
}

/// Stages of a scene up to `direct`.
struct DirectScene {
  Scene scene;
  World world;
  RayScene rays;
  Plan plan;

  explicit DirectScene(Scene s)
      : scene(std::move(s)), world(make_world(scene)), rays(world), plan(make_plan(scene, world)) {}

  DiffuseProfile profile() const { return make_diffuse_profile(scene.media[0]); }
  EntrySampler sampler(EntryStrategy strategy) const {
    return EntrySampler(plan.groups.at(0), profile(), rays, world.diagonal, strategy);
  }
  std::uint32_t triangles(std::size_t mesh) const {
    return std::uint32_t(world.meshes[mesh].triangles.size());
  }

  /// Goes on from `state` until there are `passes`.
  DirectResult run(DirectState& state, std::size_t passes, Monitor* monitor = nullptr,
                   const std::function<void(const DirectState&)>& after_pass = {}) {
    scene.settings.entry_samples = passes * entry_samples_per_pass(scene.film);
    return render_direct({scene, world, rays, plan, monitor}, state, after_pass);
  }
  Image picture(std::size_t passes) {
    DirectState state;
    return run(state, passes).picture.image;
  }
};

}  // namespace opaline::test
