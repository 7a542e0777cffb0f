// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/mirrored_light.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "core/parallel.h"
#include "irradiance/shadow_batch.h"
#include "volume/nearest_sample.h"

namespace opaline {
namespace {

constexpr std::uint64_t kSeed = 4900;
constexpr std::size_t kSamplesAtOnce = 1024;
constexpr float kReach = 3;  // radius of the mean around a sample, spacings

/// Light arriving at a sample.
struct Arrival {
  std::size_t body, sample;
  RgbF power;  ///< W, transmitted
};

class Mirrors {
 public:
  Mirrors(const PrecomputeInput& input, std::span<const Body> bodies)
      : input_(input),
        bodies_(bodies),
        lights_(recentred_lights(input.scene, input.world)),
        body_of_mesh_(input.world.meshes.size()) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      nearest_.push_back(std::make_unique<const NearestSample>(bodies[b].surface.samples, &input.world));
      for (const std::uint32_t mesh : bodies[b].plan.meshes) body_of_mesh_[mesh] = b;
    }
  }

  /// From a range of a body's samples.
  std::vector<Arrival> arrivals(const Body& body, std::size_t begin, std::size_t end) const {
    std::vector<TracedRay> rays;
    std::vector<RgbF> power;
    for (std::size_t l = 0, together = 0; l < lights_.size(); l += together) {
      together = sharing_rays(std::span(lights_).subspan(l));
      add_rays(body, begin, end, std::span(lights_).subspan(l, together), rays, power);
    }
    input_.rays.intersect(rays);
    std::vector<Arrival> arriving;
    for (std::size_t r = 0; r < rays.size(); ++r)
      if (const std::optional<Arrival> arrival = arrival_of(rays[r], power[r])) arriving.push_back(*arrival);
    return arriving;
  }

 private:
  /// in    lights: sharing their rays
  /// out   power: mirrored along each ray, W
  void add_rays(const Body& body, std::size_t begin, std::size_t end, std::span<const Light> lights,
                std::vector<TracedRay>& rays, std::vector<RgbF>& power) const {
    ShadowBatch batch(input_.rays, lights, {}, 1, light_seed(input_.scene.settings.seed + kSeed, lights[0]));
    batch.keep_directions();
    std::vector<SurfacePoint> points;
    for (std::size_t i = begin; i < end; ++i) {
      const SurfaceSample& sample = body.surface.samples[i];
      points.push_back(input_.rays.surface_point(sample.mesh, sample.triangle, sample.u, sample.v));
      batch.add(points.back(), i);
    }
    std::vector<RgbF> irradiance(points.size());
    std::vector<Vec3f> towards_light(points.size());
    batch.trace_lights([&](std::size_t l, std::size_t p, int s, float lit, float) {
      irradiance[p] += RgbF(emission(lights[l])) * lit;
      towards_light[p] = batch.direction(p, s);
    });
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (irradiance[p] == RgbF{}) continue;
      const SurfacePoint& point = points[p];
      const float cosine = std::min(dot(towards_light[p], point.normal), 1.f);
      const Vec3f along = point.normal * (2 * cosine) - towards_light[p];
      if (!(dot(along, point.geometric) > 0)) continue;
      const OuterBoundary boundary = body.boundary.at(point);
      const float past_fuzz = boundary.past_fuzz(cosine),
                  mirrored = fresnel_reflectance(cosine, boundary.eta()) * past_fuzz * past_fuzz;
      rays.push_back({Ray(point.position + point.geometric * point.offset, along), {}});
      power.push_back(irradiance[p] * (mirrored * body.surface.samples[begin + p].area));
    }
  }

  std::optional<Arrival> arrival_of(const TracedRay& traced, const RgbF& power) const {
    const auto& [ray, hit] = traced;
    if (hit.mesh == Hit::kMiss || !body_of_mesh_[hit.mesh]) return {};
    const SurfacePoint point = input_.rays.surface_point(hit.mesh, hit.triangle, hit.u, hit.v);
    const float cosine = -dot(ray.direction, point.normal);
    if (!(cosine > 0 && dot(ray.direction, point.geometric) < 0)) return {};
    const std::size_t body = *body_of_mesh_[hit.mesh];
    const float transmitted = bodies_[body].boundary.at(point).transmittance(std::min(cosine, 1.f));
    return Arrival{body, nearest_[body]->at(point.position, point.geometric), power * transmitted};
  }

  const PrecomputeInput& input_;
  std::span<const Body> bodies_;
  std::vector<Light> lights_;
  std::vector<std::unique_ptr<const NearestSample>> nearest_;  // by body
  std::vector<std::optional<std::size_t>> body_of_mesh_;
};

/// Power over area, both summed around each sample.
std::vector<RgbF> spread(const SurfaceSamples& surface, std::span<const RgbF> power) {
  const std::vector<SurfaceSample>& samples = surface.samples;
  const auto reach = float(kReach * surface.spacing());
  const NearestSample grid(samples, nullptr, kReach);
  const auto for_around = [&](std::size_t i, const auto& use) {
    grid.for_near(samples[i].position, reach, [&](const NearestSample::Member& member) {
      const Vec3f apart = member.position - samples[i].position;
      const float near = 1 - dot(apart, apart) / (reach * reach);
      if (near > 0 && dot(member.normal, samples[i].normal) > 0) use(member.sample, near);
    });
  };
  std::vector<RgbF> irradiance(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (power[i] != RgbF{})
      for_around(i, [&](std::uint32_t j, float near) { irradiance[j] += power[i] * near; });
  parallel_chunks(samples.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      if (irradiance[i] == RgbF{}) continue;
      float area = 0;
      for_around(i, [&](std::uint32_t j, float near) { area += samples[j].area * near; });
      irradiance[i] *= 1 / area;
    }
  });
  return irradiance;
}

}  // namespace

std::vector<std::vector<RgbF>> mirrored_at_samples(const PrecomputeInput& input,
                                                   std::span<const Body> bodies) {
  std::vector<std::vector<RgbF>> irradiance(bodies.size()), power;
  std::vector<char> is_lit(bodies.size());
  for (const Body& body : bodies) power.emplace_back(body.surface.samples.size());
  const Mirrors mirrors(input, bodies);
  for (const Body& body : bodies) {
    const float eta = body.boundary.eta();
    if (eta == 0 || eta == 1) continue;
    const std::size_t count = body.surface.samples.size();
    std::vector<std::vector<Arrival>> parts(chunk_count(count, kSamplesAtOnce));
    parallel_chunks(count, kSamplesAtOnce, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      parts[chunk] = mirrors.arrivals(body, begin, end);
    });
    for (const std::vector<Arrival>& part : parts)
      for (const Arrival& arrival : part) {
        power[arrival.body][arrival.sample] += arrival.power;
        is_lit[arrival.body] = true;
      }
  }
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (is_lit[b]) irradiance[b] = spread(bodies[b].surface, power[b]);
  return irradiance;
}

}  // namespace opaline
