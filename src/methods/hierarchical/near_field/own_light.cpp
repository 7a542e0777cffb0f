// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/near_field/own_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/parallel.h"
#include "core/random.h"
#include "exitance/refined_stake.h"
#include "exitance/surface_patch.h"
#include "methods/hierarchical/hierarchical_state.h"
#include "scene/scene_properties.h"

namespace opaline {
namespace {

// Above this fraction of the irradiance at the point itself (SplitKernel::own_irradiance) the near field's rms
// radius is under a fifth of h, less than two segments of the finest lattice.
constexpr float kSharp = 0.8f;
// Error, over the tolerance, that lattices need not resolve: bumps of the mesh, resolved by its own
// vertices, and noise of a few shadow rays beside a shadow's edge.
constexpr float kBumps = 1, kEdgeNoise = 2;
// Sensitivity to the near field's irradiance (stake_of), over the tolerance, above which points are evaluated directly.
// `render scenes/bunny-marble.json --resolution 2048x2048 --evaluator surface_cache` against brute_force, p99
// over all / over the ear: 1: .31 / .63 %, .5: .23 / .27 %.
constexpr float kTooSharp = 0.5f;

std::uint64_t key_of(const Vec3f& p) {
  std::array<std::uint32_t, 3> bits;
  std::memcpy(bits.data(), &p, sizeof bits);
  return hash_bits(hash_bits(bits[0], bits[1]), bits[2]);
}

}  // namespace

bool can_hold_own_light(const Scene& scene, const World& world, const Body& group) {
  const SplitKernel& kernel = hierarchical_state(group).kernel();
  const auto& own = kernel.own_irradiance;
  return bounces_of(scene) == 0 && kernel.needs_irradiance() &&
         std::ranges::all_of(own, [](float s) { return s <= kSharp; }) &&
         std::ranges::none_of(group.plan.meshes,
                              [&](std::uint32_t m) { return world.meshes[m].normals.empty(); });
}

OwnLight::OwnLight(const PrecomputeInput& input, const Body& group)
    : input_(input),
      group_(group),
      lights_(recentred_lights(input.scene, input.world)),
      near_field_(group, input.scene.settings.light_samples),
      holds_edges_(input.scene.settings.evaluator != EvaluatorKind::surface_cache) {}

void OwnLight::add(std::span<const SurfacePoint> points, std::span<Exitance> exitance,
                   std::span<PlaceDoubt> doubts) const {
  parallel_chunks(points.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    const std::size_t n = end - begin;
    add_to_chunk(points.subspan(begin, n), exitance.subspan(begin, n), doubts.subspan(begin, n));
  });
}

void OwnLight::add_to_chunk(std::span<const SurfacePoint> points, std::span<Exitance> exitance,
                            std::span<PlaceDoubt> doubts) const {
  const Settings& settings = input_.scene.settings;
  std::vector<std::uint64_t> keys;
  for (const SurfacePoint& point : points) keys.push_back(key_of(point.position));
  std::vector<Rgb> variance(points.size());
  PointIrradianceInput lighting{input_.rays,
                                points,
                                keys,
                                lights_,
                                input_.scene.media[group_.plan.medium].eta,
                                settings.light_samples,
                                point_irradiance_seed(settings),
                                variance};
  const std::vector<RgbF> own = irradiance_at(lighting);
  const auto& share = hierarchical_state(group_).kernel().own_irradiance;
  for (std::size_t i = 0; i < points.size(); ++i) {
    exitance[i].exitance += own_part(share, exitance[i], own[i]);
    const Rgb& v = variance[i];
    const RgbF noise =
        own_part(share, exitance[i], RgbF(Rgb{std::sqrt(v.x), std::sqrt(v.y), std::sqrt(v.z)}));
    doubts[i].noise = noise * 2;
    variance[i] = Rgb(noise) * Rgb(noise);
  }
  lighting.variance = {};
  const float tolerance = float(settings.tolerance);
  if (holds_edges_) {
    for (std::size_t i = 0; i < points.size(); ++i)
      doubts[i].noise += exitance[i].exitance * (kBumps * tolerance);
    for (const std::uint32_t i : near_field_.refine(lighting, own, exitance, variance)) {
      doubts[i].noise += exitance[i].exitance * (kEdgeNoise * tolerance);
      doubts[i].beside_edge = true;
    }
  } else {
    for (std::size_t i = 0; i < points.size(); ++i)
      doubts[i].is_too_sharp = stake_of(share, own[i], exitance[i]) > kTooSharp * tolerance;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    exitance[i].irradiance = own[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = double(exitance[i].error[c]);
      exitance[i].error[c] = float(std::sqrt(error * error + variance[i][c]));
    }
  }
}

}  // namespace opaline
