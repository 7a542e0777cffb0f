// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/surface_caches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "exitance/refined_stake.h"
#include "exitance/surface_cache.h"
#include "exitance/surface_patch.h"
#include "methods/hierarchical/hierarchical_state.h"
#include "methods/hierarchical/near_field/near_field_sampler.h"
#include "render/camera_rays.h"
#include "scene/scene_properties.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

/// Adds the exitance depending on the irradiance at the shader's points themselves. Beside shadow edges, an
/// explicitly requested cache leaves it to the points, to meet its tolerance; an automatic one, made for
/// speed, stores the estimate of a few shadow rays.
class OwnLight {
 public:
  /// Both must outlive the object.
  OwnLight(const PrecomputeInput& input, const Body& group);

  /// As AddOwnLight.
  void add(std::span<const SurfacePoint> points, std::span<Exitance> exitance,
           std::span<PlaceDoubt> doubts) const;

 private:
  void add_to_chunk(std::span<const SurfacePoint> points, std::span<Exitance> exitance,
                    std::span<PlaceDoubt> doubts) const;

  const PrecomputeInput& input_;
  const Body& group_;
  std::vector<Light> lights_;
  NearFieldSampler near_field_;
  bool holds_edges_;
};

// Largest weight of the point's own irradiance (SplitKernel::own_irradiance) that a cache resolves. Above it,
// the near field's rms radius is under a fifth of h, less than two segments of the finest lattice.
constexpr float kSharp = 0.8f;
// Interpolation error, over the tolerance, left to lattices: at bumps of the mesh, resolved by its own
// vertices, and by noise of a few shadow rays beside an edge.
constexpr float kBumps = 1, kEdgeNoise = 2;
// Stake (stake_of), over the tolerance, above which points are evaluated directly; src/exitance/README.md has
// the comparison.
constexpr float kTooSharp = 0.5f;

std::uint64_t key_of(const Vec3f& p) {
  std::array<std::uint32_t, 3> bits;
  std::memcpy(bits.data(), &p, sizeof bits);
  return hash_bits(hash_bits(bits[0], bits[1]), bits[2]);
}

/// True if a cache can store the exitance depending on the point's own irradiance, so images trace no shadow
/// rays. Excludes meshes without smooth normals, whose facets differ in irradiance; mean free paths far below
/// the sample spacing, whose shadows are too sharp to interpolate; textures of fuzz; maps of normals and heights;
/// and bounced light, computed at the image's points only.
bool can_hold_own_light(const Scene& scene, const World& world, const Body& group) {
  const SplitKernel& kernel = hierarchical_state(group).kernel();
  const auto& own = kernel.own_irradiance;
  return bounces_of(scene) == 0 && kernel.needs_irradiance() && !group.boundary.is_textured() &&
         !has_maps(scene, group.plan.meshes) &&
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
                                group_.boundary,
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

// Largest ratios of a cache's vertices, and of its points, to the image's points on the body. A cache point
// costs about three times a hit, being sparser and more often beside a shadow edge; a lookup costs a tenth.
// src/exitance/README.md has the break-even.
constexpr double kBegin = 0.11, kMost = 0.4;

// Estimates the image's points on each mesh, by rays through a few pixels.
std::vector<double> expected_points(const PrecomputeInput& input) {
  constexpr int kColumns = 48, kRows = 48;
  const Film& film = input.scene.film;
  const CameraRays camera(input.scene.camera, film, input.world);
  std::vector<TracedRay> rays;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      rays.push_back({camera.middle_ray((2 * column + 1) * film.resolution[0] / (2 * kColumns),
                                        (2 * row + 1) * film.resolution[1] / (2 * kRows)),
                      {}});
  intersect_from_camera(input.scene, input.rays, rays);
  const double each =
      double(film.resolution[0]) * double(film.resolution[1]) * film.samples_per_pixel / double(rays.size());
  std::vector<double> points(input.world.meshes.size());
  for (const TracedRay& traced : rays)
    if (traced.hit.mesh != Hit::kMiss) points[traced.hit.mesh] += each;
  return points;
}

bool is_worth_beginning(const PrecomputeInput& input, const Body& group, std::size_t most_places) {
  return most_places > 0 &&
         double(least_cache_places(input.world, group.plan.meshes, hierarchical_state(group).kernel())) <=
             kBegin / kMost * double(most_places);
}

std::size_t vertices_of(const BodyPlan& group, const World& world) {
  std::size_t vertices = 0;
  for (const std::uint32_t mesh : group.meshes) vertices += world.meshes[mesh].positions.size();
  return vertices;
}

}  // namespace

std::size_t most_wanted_places(const BodyPlan& group, const World& world) {
  constexpr std::size_t kOfVertex = 4, kOfSample = 16;
  return kOfVertex * vertices_of(group, world) + kOfSample * group.samples;
}

std::size_t expected_cache_places(const Scene& scene, const BodyPlan& group, const World& world) {
  // Measured by bench_plan. Beside shadow edges, lattices as fine as the samples; a sphere has none of its own.
  constexpr double kVertices = 1.05, kInLattices = 5.5, kLeastInLattices = 3e4, kOfSample = 1.6, kOfFew = 8,
                   kFew = 1e4, kMany = 1e5;
  const bool is_sphere = std::ranges::all_of(group.meshes, [&](std::uint32_t mesh) {
    return std::holds_alternative<SphereShape>(scene.shapes[mesh].source);
  });
  const auto vertices = double(vertices_of(group, world)), samples = double(group.samples);
  const double places = is_sphere ? kVertices * vertices + kOfSample * samples + std::max(0., samples - kFew)
                                  : std::min(kVertices * vertices + kOfFew * samples,
                                             std::max(kInLattices * vertices, kLeastInLattices) +
                                                 kOfSample * samples + std::min(samples, kMany));
  return std::min(most_wanted_places(group, world), std::size_t(places));
}

std::vector<std::size_t> most_cache_places(const PrecomputeInput& input, std::span<const Body> groups,
                                           std::size_t pictures) {
  const EvaluatorKind evaluator = input.scene.settings.evaluator;
  std::vector<std::size_t> most(groups.size());
  const auto may_have_one = [&](const Body& body) {
    return method_of(body.plan.method).may_use_surface_cache() && body.entering.empty();
  };
  if (evaluator == EvaluatorKind::surface_cache)
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (may_have_one(groups[g])) most[g] = most_wanted_places(groups[g].plan, input.world);
  if (std::ranges::none_of(groups, may_have_one) || evaluator != EvaluatorKind::automatic) return most;
  const std::vector<double> points = expected_points(input);
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (may_have_one(groups[g]))
      for (const std::uint32_t m : groups[g].plan.meshes)
        most[g] += std::size_t(kMost * double(pictures) * points[m]);
  return most;
}

bool may_use(const SurfaceCache& cache, const PrecomputeInput& input, const Body& group,
             std::size_t most_places) {
  return is_worth_beginning(input, group, most_places) && cache.places() <= most_places;
}

std::optional<SurfaceCache> make_body_cache(const PrecomputeInput& input, const Body& group,
                                            std::size_t most_places) {
  if (!is_worth_beginning(input, group, most_places)) return {};
  const HierarchicalState& state = hierarchical_state(group);
  const Settings& settings = input.scene.settings;
  if (input.monitor != nullptr) input.monitor->begin("exitance", 0);
  std::optional<OwnLight> own_light;
  if (can_hold_own_light(input.scene, input.world, group)) own_light.emplace(input, group);
  return make_surface_cache(
      {.world = input.world,
       .meshes = group.plan.meshes,
       .octree = state.octree(),
       .kernel = state.kernel(),
       .tolerance = settings.tolerance,
       .instruction_set = settings.laboratory.instruction_set,
       .cloud = state.cloud,
       .most_places = most_places,
       .add_own_light = own_light ? std::bind_front(&OwnLight::add, &*own_light) : AddOwnLight(),
       .monitor = input.monitor});
}
}  // namespace opaline
