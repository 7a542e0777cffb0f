// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/gathered_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace opaline {
namespace {

using Met = HeldView::Gathered::Met;

// Limits the memory of a thread, to about 6 MB; bench_plan.
constexpr std::size_t kMostRaysAtOnce = 24 * kGatheredAtOnce;

// Rays sampled at a few points, in order, and those of them with hits.
struct Rays {
  std::vector<TracedRay> rays;
  std::vector<Met> met;
};

Ray leaving(const SurfacePoint& point, const Vec3f& direction) {
  return {point.position + point.geometric * point.offset, direction};
}

// Cosine-distributed directions on the outside of the surface.
void add_rays(const GatherInput& input, std::size_t p, std::uint32_t place, Rays& drawn) {
  const SurfacePoint& point = input.points[p];
  Vec3f x, y;
  tangent_frame(point.normal, x, y);
  const std::uint64_t key = input.keys[p];
  const std::array<double, 2> shift{unit_double(hash_bits(input.seed, 2 * key)),
                                    unit_double(hash_bits(input.seed, 2 * key + 1))};
  for (int k = 0; k < input.rays_each; ++k) {
    const auto [u, v] = r2_point(std::uint64_t(k), shift);
    const float radius = float(std::sqrt(u)), cosine = float(std::sqrt(1 - u));
    const double angle = 2 * std::numbers::pi * v;
    const Vec3f direction =
        x * (radius * float(std::cos(angle))) + y * (radius * float(std::sin(angle))) + point.normal * cosine;
    if (!(dot(direction, point.geometric) > 0)) continue;
    drawn.rays.push_back({leaving(point, direction), {}});
    drawn.met.push_back({direction, 0, cosine, 0, 0, 0, 0, place, std::uint32_t(k)});
  }
}

// Removes the rays without a hit.
void keep_hits(Rays& drawn) {
  std::size_t kept = 0;
  for (std::size_t r = 0; r < drawn.rays.size(); ++r) {
    const auto& [ray, hit] = drawn.rays[r];
    if (hit.mesh == Hit::kMiss) continue;
    const Met& of = drawn.met[r];
    drawn.met[kept] = {ray.direction, ray.far, of.cosine, hit.mesh, hit.triangle,
                       hit.u,         hit.v,   of.point,  of.number};
    drawn.rays[kept++] = drawn.rays[r];
  }
  drawn.rays.resize(kept);
  drawn.met.resize(kept);
}

Rays traced(const GatherInput& input, std::size_t begin, std::size_t end) {
  Rays drawn;
  for (std::size_t p = begin; p < end; ++p) add_rays(input, p, std::uint32_t(p - begin), drawn);
  input.rays.intersect(drawn.rays);
  keep_hits(drawn);
  return drawn;
}

std::vector<TracedRay> rays_again(const GatherInput& input, std::size_t begin, std::span<const Met> met) {
  std::vector<TracedRay> rays;
  rays.reserve(met.size());
  for (const Met& m : met) {
    rays.push_back({leaving(input.points[begin + m.point], m.direction), {}});
    TracedRay& traced = rays.back();
    traced.ray.far = m.far;
    traced.hit.mesh = m.mesh;
    traced.hit.triangle = m.triangle;
    traced.hit.u = m.u;
    traced.hit.v = m.v;
  }
  return rays;
}

void use_all(const GatherInput& input, std::size_t begin, std::span<const TracedRay> rays,
             std::span<const Met> met, HeldView::Batch* held, const UseOfGathered& use) {
  std::vector<std::uint64_t> keys;
  keys.reserve(met.size());
  for (const Met& m : met) keys.push_back(hash_bits(input.keys[begin + m.point], std::uint64_t(m.number)));
  std::vector<RgbF> further(rays.size());
  const std::vector<RgbF> radiance = input.shader.radiance_along(rays, keys, held, further);
  const float each = float(std::numbers::pi) / float(input.rays_each);
  OuterBoundary boundary = input.boundary;
  for (std::size_t r = 0; r < radiance.size(); ++r) {
    if (input.boundary.is_textured() && (r == 0 || met[r].point != met[r - 1].point))
      boundary = input.boundary.at(input.points[begin + met[r].point]);
    const float transmitted = boundary.transmittance(met[r].cosine);
    const Ray& ray = rays[r].ray;
    const float factor = each * transmitted;
    use({begin + met[r].point, ray.direction, ray.far, radiance[r] * factor, further[r] * factor});
  }
}

}  // namespace

void for_each_gathered(const GatherInput& input, const UseOfGathered& use) {
  const std::size_t points_at_once =
      std::clamp<std::size_t>(kMostRaysAtOnce / std::size_t(input.rays_each), 1, kGatheredAtOnce);
  const std::size_t parts = (input.points.size() + points_at_once - 1) / points_at_once;
  if (input.held != nullptr) input.held->parts.resize(parts);
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * points_at_once,
                      end = std::min(begin + points_at_once, input.points.size());
    HeldView::Gathered* const held = input.held != nullptr ? &input.held->parts[part] : nullptr;
    if (held != nullptr && held->is_traced) {
      use_all(input, begin, rays_again(input, begin, held->met), held->met, &held->seen, use);
      continue;
    }
    Rays drawn = traced(input, begin, end);
    const bool is_kept = held != nullptr && *input.view->gathered_bytes < kMostGatheredBytes;
    use_all(input, begin, drawn.rays, drawn.met, is_kept ? &held->seen : nullptr, use);
    if (!is_kept) continue;
    held->met = std::move(drawn.met);
    held->met.shrink_to_fit();
    held->is_traced = true;
    *input.view->gathered_bytes += held->bytes();
  }
}

HeldView::Gathering& gathering_of(HeldView::Gathering& held, const std::vector<std::uint32_t>& points) {
  if (held.points != points) held = {points, {}};
  return held;
}

HeldView::Gathering& gathering_of(std::unique_ptr<HeldView::Gathering>& held,
                                  const std::vector<std::uint32_t>& points) {
  if (held == nullptr) held = std::make_unique<HeldView::Gathering>();
  return gathering_of(*held, points);
}

std::vector<RgbF> gathered_irradiance(const GatherInput& input) {
  std::vector<RgbF> irradiance(input.points.size());
  for_each_gathered(input, [&](const SurfaceLight& light) { irradiance[light.point] += light.irradiance; });
  return irradiance;
}

}  // namespace opaline
