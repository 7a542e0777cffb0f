// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/body_walks.h"

#include <cmath>

namespace opaline {
namespace {

constexpr double kReach = 2;   // mean free paths: farther boundaries are met by chance, not by expectation
constexpr double kDeep = 1;    // mean free paths: deeper than that flights go without a ray
constexpr double kVoxel = .5;  // mean free paths: edge of the safe distance's grid
constexpr std::uint64_t kMostFlights = 1'000'000;
constexpr int kMostBounces = 16;      // outside, from one place of the body to another
constexpr double kOutsideShare = .5;  // of a walk's first weight: what light outside is rounded to

double surface_area(const VolumeInput& input) {
  double area = 0;
  for (const std::uint32_t m : input.meshes) area += opaline::surface_area(input.world.meshes[m]);
  return area;
}

double least_mean_free_path(const VolumeInput& input) {
  double least = std::numeric_limits<double>::infinity();
  for (const HomogeneousMedium& medium : input.media)
    if (medium.sigma_s > 0) least = std::min(least, 1 / medium.sigma_t());
  return least;
}

/// Uniform over the sphere (Marsaglia 1972).
Vec3d any_direction(WalkNumbers& numbers) {
  for (;;) {
    const auto [x, y] = numbers.next_pair();
    const double s = x * x + y * y;
    if (s < 1) {
      const double k = 2 * std::sqrt(1 - s);
      return {x * k, y * k, 1 - 2 * s};
    }
  }
}

}  // namespace

/// One start's light: the walk inside, and those that begin where it enters again.
struct BodyWalks::Walker {
  const BodyWalks& body;
  const HomogeneousMedium& medium;
  WalkCounts& counts;
  WalkNumbers numbers, outside_numbers;
  double outside_weight = 0;
  std::vector<WalkState>& pending;
  const double sigma_t = medium.sigma_t(), albedo = medium.albedo(), reach = kReach / sigma_t,
               deep = kDeep / sigma_t;

  void count(const Vec3d& position, const Vec3d& normal, double weight) {
    counts.flux[body.cells_.at(Vec3f(position), Vec3f(normal))] += float(weight);
  }

  // Light that has left or was reflected: a ray for a share of it.
  void send_outside(const SurfacePoint& point, const Vec3d& direction, double weight) {
    if (weight < outside_weight) {
      if (outside_numbers.next() * outside_weight >= weight) return;
      weight = outside_weight;
    }
    meet_again(point, direction, weight);
  }

  void meet_again(const SurfacePoint& point, Vec3d direction, double weight) {
    Vec3d from = body.inside_.moved_off(point, 1);
    for (int bounces = 0; bounces < kMostBounces; ++bounces) {
      const std::optional<SurfacePoint> met = body.inside_.entry(from, direction);
      if (!met) return;
      const Vec3d normal(met->geometric);
      const double cosine = std::min(1.0, -dot(normal, direction));
      if (outside_numbers.next() >= fresnel_reflectance(cosine, medium.eta)) {
        pending.push_back(
            {body.inside_.moved_off(*met, -1), refracted_inward(direction, normal, medium.eta), weight, 0});
        return;
      }
      direction = mirrored(direction, normal);
      from = body.inside_.moved_off(*met, 1);
    }
  }

  void walk(WalkState state) {
    const double least = .2 * state.weight;
    for (std::uint64_t flights = 0; flights < kMostFlights; ++flights) {
      const double safe = body.safe_.at(state.position);
      if (safe < 0) break;
      bool collides = true;
      if (safe > deep) {
        const double distance = -std::log(1 - numbers.next()) / sigma_t;
        collides = distance < safe;
        state.position += state.direction * (collides ? distance : safe);
        if (!collides) continue;
      } else {
        collides = fly_to_wall(state);
      }
      if (collides) {
        state.weight *= albedo;
        if (!survives_long(state.weight, ++state.collisions, numbers)) return;
        state.direction =
            medium.g == 0 ? any_direction(numbers) : scattered(state.direction, medium.g, numbers);
      }
      if (!survives(state.weight, least, numbers)) return;
    }
    counts.lost += state.weight;
  }

  // Whether the flight ends in a collision. Free paths have no memory: one that ends within reach of no wall goes
  // on from there.
  bool fly_to_wall(WalkState& state) {
    const Wall wall = body.inside_.wall(state.position, state.direction, reach);
    if (!std::isfinite(wall.distance)) {
      const double distance = -std::log(1 - numbers.next()) / sigma_t;
      state.position += state.direction * std::min(distance, reach);
      return distance < reach;
    }
    Crossing crossing = cross(medium, state, {wall.distance, wall.normal});
    if (!wall.is_body) crossing.reflectance = 0;
    const Flight flight = fly(medium, state.weight, {wall.distance, {}}, crossing, numbers);
    if (!wall.is_body) counts.stopped += flight.leaving;
    if (flight.leaving > 0 && wall.is_body) {
      count(state.position + state.direction * wall.distance, wall.normal, flight.leaving);
      if (body.input_.reenter)
        send_outside(body.inside_.point(wall.hit),
                     refracted_outward(state.direction, wall.normal, medium.eta), flight.leaving);
    }
    state.weight = flight.remaining;
    if (flight.collides) {
      state.position += state.direction * flight.distance;
    } else {
      state.position = body.inside_.moved_off(body.inside_.point(wall.hit), -1);
      state.direction = mirrored(state.direction, wall.normal);
    }
    return flight.collides;
  }
};

BodyWalks::BodyWalks(const VolumeInput& input, std::size_t starts)
    : input_(input),
      points_(input.rays, input.world, input.meshes, surface_area(input) / double(starts)),
      inside_(input.rays, input.world, input.meshes),
      safe_(input.world, inside_.box(), kVoxel * least_mean_free_path(input)),
      cells_(input.samples, &input.world),
      starts_(starts) {}

// Channels of a light have the starts in common: what differs between them is not their noise.
WalkCounts BodyWalks::walk(const WalkJob& job, std::size_t pass, std::size_t chunk) const {
  const HomogeneousMedium& medium = input_.media[job.channel];
  WalkCounts counts;
  counts.flux.resize(input_.samples.size());
  std::vector<WalkState> pending;
  std::size_t hint = 0;
  for (std::size_t k = starts_ * chunk / kChunks; k < starts_ * (chunk + 1) / kChunks; ++k) {
    const std::uint64_t start = pass * starts_ + k;
    WalkNumbers numbers(job.seed, start);
    const double share = (double(k) + numbers.next()) / double(starts_);
    const double u = numbers.next(), v = numbers.next();
    const SurfacePoint entry = points_.at(share, u, v, hint);
    const ArrivedLight light = light_at(input_.rays, job.lights, job.unit_emission, entry, numbers);
    const double irradiance = light.irradiance[job.channel];
    if (!(irradiance > 0)) continue;
    const Vec3d normal(entry.geometric);
    const double reflectance = fresnel_reflectance(std::min(1.0, -dot(normal, light.direction)), medium.eta);
    const double weight = irradiance * (1 - reflectance);
    counts.entered += weight;
    Walker walker{*this,
                  medium,
                  counts,
                  WalkNumbers(job.seed + 1 + 2 * job.channel, start),
                  WalkNumbers(job.seed + 2 + 2 * job.channel, start),
                  kOutsideShare * irradiance,
                  pending};
    if (weight > 0)
      pending.push_back(
          {inside_.moved_off(entry, -1), refracted_inward(light.direction, normal, medium.eta), weight, 0});
    if (input_.reenter && reflectance > 0)
      walker.send_outside(entry, mirrored(light.direction, normal), irradiance * reflectance);
    while (!pending.empty()) {
      const WalkState state = pending.back();
      pending.pop_back();
      walker.walk(state);
    }
  }
  return counts;
}

}  // namespace opaline
