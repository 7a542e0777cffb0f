// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/near_field_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "opaline/core/random.h"

namespace opaline {
namespace {

// The exitance that hangs on which of the two irradiances is right, above which shadow rays are worth their
// time.
constexpr float kWorth = 0.02f;

constexpr std::size_t kRings = 1024;

// Parts of the near kernel of a channel that fall on rings of equal width out to h; sum 1, or all 0.
std::array<double, kRings> near_rings(const ChannelProfile& profile, double h) {
  std::array<double, kRings> rings;
  double sum = 0;
  for (std::size_t i = 0; i < kRings; ++i) {
    rings[i] = near_ring(profile, h, (double(i) + 0.5) / kRings);
    sum += rings[i];
  }
  for (double& ring : rings) ring = sum > 0 ? ring / sum : 0;
  return rings;
}

}  // namespace

// Places of the marked points, on the surface once found.
struct NearFieldSampler::Places {
  std::vector<TracedRay> rays;
  std::vector<SurfacePoint> points;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> owners, places;  // of the points; of the pattern
};

// Each place stands for an equal part of the channels' mean near kernel.
NearFieldSampler::NearFieldSampler(const TranslucentGroup& group)
    : kernel_(group.kernel), is_own_mesh_(*std::ranges::max_element(group.plan.meshes) + 1) {
  for (const std::uint32_t mesh : group.plan.meshes) is_own_mesh_[mesh] = true;
  std::array<std::array<double, kRings>, 3> rings{};
  double channels = 0;
  for (std::size_t c = 0; c < 3; ++c)
    if (kernel_.own_irradiance[c] > 0) {
      rings[c] = near_rings(group.profile.channels[c], double(kernel_.radius));
      channels += 1;
    }
  double before = 0;
  for (std::size_t i = 0; i < kRings; ++i) {
    const double part = (rings[0][i] + rings[1][i] + rings[2][i]) / channels, middle = before + part / 2;
    Place& place = pattern_[std::min(std::size_t(middle * kPlaces), kPlaces - 1)];
    place.weight += RgbF{float(rings[0][i]), float(rings[1][i]), float(rings[2][i])};
    place.distance += float(part * kPlaces * (double(i) + 0.5) / kRings) * kernel_.radius;
    before += part;
  }
}

std::vector<std::uint32_t> NearFieldSampler::refine(const PointIrradianceInput& lighting,
                                                    std::span<const RgbF> own,
                                                    std::span<Exitance> exitance) const {
  Places places;
  std::vector<std::uint32_t> marked;
  for (std::uint32_t i = 0; i < exitance.size(); ++i)
    if (is_beside_edge(own[i], exitance[i])) {
      add_places(lighting.points[i], std::uint32_t(marked.size()), lighting.keys[i], places);
      marked.push_back(i);
    }
  if (marked.empty()) return marked;
  find(lighting.rays, places);
  PointIrradianceInput around = lighting;
  around.points = places.points;
  around.keys = places.keys;
  around.light_samples = std::max(1, lighting.light_samples / int(kPlaces));
  around.variance = {};
  const std::vector<RgbF> entered = irradiance_at(around);
  std::vector<RgbF> sums(marked.size()), weights(marked.size());
  for (std::size_t i = 0; i < entered.size(); ++i) {
    const RgbF& weight = pattern_[places.places[i]].weight;
    sums[places.owners[i]] += weight * entered[i];
    weights[places.owners[i]] += weight;
  }
  for (std::size_t m = 0; m < marked.size(); ++m) {
    Exitance& e = exitance[marked[m]];
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(weights[m][c] > 0)) continue;
      const float share = kernel_.own_irradiance[c],
                  mixed = share * own[marked[m]][c] + (1 - share) * e.irradiance[c];
      e.exitance[c] += e.near[c] * (sums[m][c] / weights[m][c] - mixed);
    }
  }
  return marked;
}

bool NearFieldSampler::is_beside_edge(const RgbF& own, const Exitance& e) const {
  for (std::size_t c = 0; c < 3; ++c) {
    const float share = kernel_.own_irradiance[c];
    if (e.near[c] * share * (1 - share) * std::abs(own[c] - e.irradiance[c]) > kWorth * e.exitance[c])
      return true;
  }
  return false;
}

// On a golden spiral, turned at random from point to point: what the few places miss becomes noise without a
// pattern.
void NearFieldSampler::add_places(const SurfacePoint& point, std::uint32_t index, std::uint64_t key,
                                  Places& places) const {
  constexpr double kGoldenAngle = 2 * std::numbers::pi * (2 - std::numbers::phi);
  Vec3f x, y;
  tangent_frame(point.normal, x, y);
  const double turn = 2 * std::numbers::pi * unit_double(hash_bits(3000, key));
  for (std::uint32_t k = 0; k < kPlaces; ++k) {
    const float r = pattern_[k].distance;
    const double angle = turn + kGoldenAngle * k;
    const Vec3f place = point.position + x * (r * float(std::cos(angle))) + y * (r * float(std::sin(angle)));
    places.rays.push_back({Ray(place + point.normal * r, -point.normal, 2 * r), {}});
    places.owners.push_back(index);
    places.places.push_back(k);
    places.keys.push_back(hash_bits(key, k));
  }
}

// Keeps the places that lie on the group's surface and show their outside.
void NearFieldSampler::find(const RayScene& rays, Places& places) const {
  rays.intersect(places.rays);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < places.rays.size(); ++i) {
    const auto& [ray, hit] = places.rays[i];
    if (hit.mesh >= is_own_mesh_.size() || !is_own_mesh_[hit.mesh]) continue;
    const SurfacePoint point = rays.surface_point(hit.mesh, hit.triangle, hit.u, hit.v);
    if (dot(point.geometric, ray.direction) >= 0) continue;
    places.points.push_back(point);
    places.owners[kept] = places.owners[i];
    places.places[kept] = places.places[i];
    places.keys[kept++] = places.keys[i];
  }
  places.owners.resize(kept);
  places.places.resize(kept);
  places.keys.resize(kept);
}

}  // namespace opaline
