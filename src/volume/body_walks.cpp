// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/body_walks.h"

#include <cmath>

namespace opaline {
namespace {

// In mean free paths; tuned by bench_walks.
constexpr double kReach = 2;         // boundaries beyond are met by chance, not by expectation
constexpr double kDeep = .5;         // at least this far from any surface, flights need no ray
constexpr double kVoxel = 1;         // edge of FreeDistance's voxels, in the channel with the shortest
constexpr double kMediumVoxel = .5;  // edge of MediumVoxels' in the mean medium
constexpr double kLeast = .2;        // Russian roulette below this fraction of the first weight
constexpr double kOutside = .5;      // the same for a walk leaving
constexpr std::uint64_t kMostFlights = 1'000'000;
constexpr int kMostBounces = 16;  // outside, from one point of the body to another

double least_mean_free_path(const std::array<HomogeneousMedium, 3>& media) {
  double least = std::numeric_limits<double>::infinity();
  for (const HomogeneousMedium& medium : media)
    if (medium.sigma_s > 0) least = std::min(least, 1 / medium.sigma_t());
  return least;
}

std::optional<MediumVoxels> voxels_of(const VolumeInput& input, const Bounds& box) {
  if (!input.media_inside) return {};
  return std::optional<MediumVoxels>(std::in_place, input.media_inside, box,
                                     kMediumVoxel * least_mean_free_path(input.media), input.layers);
}

}  // namespace

/// Walks of one start: the first, and those from re-entries.
class BodyWalks::Walker {
 public:
  /// weight: of the light arriving
  Walker(const BodyWalks& body, std::size_t channel, const SphereExits& exits, WalkCounts& counts,
         WalkNumbers inside_numbers, WalkNumbers outside_numbers, double weight)
      : body_(body),
        channel_(channel),
        medium_(body.medium(channel)),
        exits_(exits),
        counts_(counts),
        numbers_(inside_numbers),
        outside_numbers_(outside_numbers),
        outside_weight_(kOutside * weight),
        sigma_t_(medium_.sigma_t()),
        log_albedo_(std::log(medium_.albedo())),
        reach_(kReach / sigma_t_),
        deep_(kDeep / sigma_t_) {}

  void arrive(const BoundaryPoint& point, const ArrivedLight& light, double weight) {
    const double cosine = std::min(1.0, -dot(point.normal, light.direction));
    const double reflectance = fresnel_reflectance(cosine, medium_.eta),
                 past_fuzz = passes_fuzz(point, cosine), enters = weight * past_fuzz * (1 - reflectance);
    counts_.entered += enters;
    if (enters > 0)
      pending_.push_back(
          {point.inside(), refracted_inward(light.direction, point.normal, medium_.eta), enters, 0});
    if (reflectance > 0)
      send_outside(point, mirrored(light.direction, point.normal),
                   weight * past_fuzz * past_fuzz * reflectance);
    while (!pending_.empty()) {
      const WalkState state = pending_.back();
      pending_.pop_back();
      walk(state);
    }
  }

 private:
  double passes_fuzz(const BoundaryPoint& at, double cosine) const {
    const OuterBoundary& boundary = body_.input_.boundary;
    if (!boundary.is_textured()) return double(boundary.past_fuzz(float(cosine)));
    SurfacePoint point{};
    point.mesh = at.mesh, point.triangle = at.triangle;
    point.u = at.u, point.v = at.v;
    return double(boundary.at(point).past_fuzz(float(cosine)));
  }

  // Continues light that has left or was reflected, and may re-enter. Uses its own random numbers: without
  // re-entry, the walks are unchanged.
  void send_outside(const BoundaryPoint& point, const Vec3d& direction, double weight) {
    if (!body_.input_.reenter) return;
    if (weight < outside_weight_) {
      if (outside_numbers_.next() * outside_weight_ >= weight) return;
      weight = outside_weight_;
    }
    meet_again(point.outside(), direction, weight);
  }

  void meet_again(Vec3d from, Vec3d direction, double weight) {
    for (int bounces = 0; bounces < kMostBounces; ++bounces) {
      const std::optional<BoundaryPoint> met = body_.inside_.entry(from, direction);
      if (!met) return;
      const double cosine = std::min(1.0, -dot(met->normal, direction));
      weight *= passes_fuzz(*met, cosine);
      if (outside_numbers_.next() >= fresnel_reflectance(cosine, medium_.eta)) {
        pending_.push_back({met->inside(), refracted_inward(direction, met->normal, medium_.eta), weight, 0});
        return;
      }
      weight *= passes_fuzz(*met, cosine);
      direction = mirrored(direction, met->normal);
      from = met->outside();
    }
  }

  void walk(WalkState state) {
    const double least = kLeast * state.weight;
    double albedo = medium_.albedo();
    const bool is_even = medium_.g == 0, may_leap = is_even && !body_.voxels_;
    bool is_scattered = false;  // in this step
    for (std::uint64_t flights = 0; flights < kMostFlights; ++flights) {
      const FreeDistance::Place place = body_.free_.place_of(state.position);
      if (place.is_outside()) break;
      const double around = body_.free_.around(place);
      if (is_scattered && may_leap && around * sigma_t_ > SphereExits::kRadii[0]) {
        if (!leap(state, around * sigma_t_)) return;
        is_scattered = false;
      } else if (around > deep_) {
        is_scattered = fly_free(state, around);
      } else if (body_.free_.is_free(place, state.direction)) {
        is_scattered = fly_free(state, body_.free_.reach());
      } else {
        is_scattered = fly_to_wall(state);
      }
      if (is_scattered && body_.voxels_) is_scattered = is_real_collision(state, albedo);
      if (is_scattered) {
        state.weight *= albedo;
        if (!survives_long(state.weight, ++state.collisions, numbers_)) return;
        state.direction =
            is_even ? even_direction(numbers_) : scattered(state.direction, medium_.g, numbers_);
      }
      if (!survives(state.weight, least, numbers_)) return;
    }
    counts_.lost += state.weight;
  }

  // Delta tracking (Woodcock et al. 1965): flights use the densest medium, and some collisions are null.
  bool is_real_collision(const WalkState& state, double& albedo) {
    const MediumVoxels::Local local = body_.voxels_->at(state.position, channel_);
    albedo = double(local.albedo);
    return numbers_.next() * sigma_t_ < double(local.sigma_t);
  }

  // True if the flight ends in a collision. Free paths are memoryless: beyond `most`, a new flight starts.
  bool fly_free(WalkState& state, double most) {
    const double distance = free_path(numbers_) / sigma_t_;
    state.position += state.direction * std::min(distance, most);
    return distance < most;
  }

  // Jumps to the surface of the largest sphere inside the body; returns whether the walk continues.
  bool leap(WalkState& state, double mean_free_paths) {
    std::size_t size = 0;
    while (size + 1 < SphereExits::kSizes && SphereExits::kRadii[size + 1] < mean_free_paths) ++size;
    const SphereExits::Exit& exit = exits_.any(size, numbers_);
    const Vec3d normal = even_direction(numbers_);
    state.position += normal * (SphereExits::kRadii[size] / sigma_t_);
    state.direction = deflected(normal, double(exit.cosine), numbers_.next_angle());
    if (exit.collisions > 0) state.weight *= std::exp(double(exit.collisions) * log_albedo_);
    return survives_long(state.weight, state.collisions, exit.collisions, numbers_);
  }

  bool fly_to_wall(WalkState& state) {
    const Wall wall = body_.inside_.wall(state.position, state.direction, reach_);
    if (!std::isfinite(wall.distance)) return fly_free(state, reach_);
    Crossing crossing = cross(medium_, state, {wall.distance, wall.point.normal});
    if (!wall.is_body) crossing.reflectance = 0;
    const Flight flight = fly(medium_, state.weight, {wall.distance, {}}, crossing, numbers_);
    if (flight.leaving > 0) leave(wall, state.direction, flight.leaving);
    state.weight = flight.remaining;
    if (flight.collides) {
      state.position += state.direction * flight.distance;
    } else {
      state.position = wall.point.inside();
      state.direction = mirrored(state.direction, wall.point.normal);
    }
    return flight.collides;
  }

  void leave(const Wall& wall, const Vec3d& direction, double weight) {
    const BoundaryPoint& point = wall.point;
    if (!wall.is_body) {
      counts_.stopped += weight;
      return;
    }
    counts_.flux[body_.cells_.at(Vec3f(point.position), Vec3f(point.normal))] += float(weight);
    const Vec3d outward = refracted_outward(direction, point.normal, medium_.eta);
    send_outside(point, outward, weight * passes_fuzz(point, dot(outward, point.normal)));
  }

  const BodyWalks& body_;
  std::size_t channel_;
  const HomogeneousMedium& medium_;
  const SphereExits& exits_;
  WalkCounts& counts_;
  WalkNumbers numbers_, outside_numbers_;
  double outside_weight_, sigma_t_, log_albedo_, reach_, deep_;
  std::vector<WalkState> pending_;
};

BodyWalks::BodyWalks(const VolumeInput& input, std::size_t starts)
    : input_(input),
      points_(input.rays, input.world, input.meshes,
              .5 * area_of(input.world, input.meshes) / double(input.samples.size())),
      inside_(input.rays, input.world, input.meshes),
      voxels_(voxels_of(input, inside_.box())),
      free_(input.world, inside_.box(), kVoxel * least_mean_free_path({medium(0), medium(1), medium(2)}),
            kReach / kVoxel),
      cells_(input.samples, &input.world),
      starts_(starts) {}

double BodyWalks::expected_bytes(const World& world, std::span<const std::uint32_t> meshes,
                                 double mean_free_path) {
  return FreeDistance::expected_bytes(world, bounds(world, meshes), kVoxel * mean_free_path);
}

SphereExits BodyWalks::exits_of(std::size_t pass) const {
  constexpr std::size_t kFewest = 64, kMost = 8192, kStarts = 8;
  return {std::clamp(starts_ / kStarts, kFewest, kMost), hash_bits(input_.seed + 1, pass)};
}

// Light entering by the normals of maps, over the surface's own.
double BodyWalks::bent_share(SurfacePoint point, const ArrivedLight& light, double eta) const {
  const double cosine = std::min(1., -dot(Vec3d(point.geometric), light.direction));
  point.normal = point.geometric;
  const double factor = double(input_.bend(point)),
               bent = std::min(1., -dot(Vec3d(point.normal), light.direction));
  if (!(bent > 0)) return 0;
  const double entering = 1 - fresnel_reflectance(bent, eta), own = 1 - fresnel_reflectance(cosine, eta);
  return factor * bent / cosine * (own > 0 ? entering / own : 1);
}

// Channels of a light share the starts, so their difference has no noise from them.
WalkCounts BodyWalks::walk(const WalkJob& job, std::size_t pass, std::size_t chunk,
                           const SphereExits& exits) const {
  WalkCounts counts;
  counts.flux.resize(input_.samples.size());
  std::size_t hint = 0;
  for (std::size_t k = starts_ * chunk / kChunks; k < starts_ * (chunk + 1) / kChunks; ++k) {
    const std::uint64_t start = pass * starts_ + k;
    WalkNumbers numbers(job.seed, start);
    const double share = (double(k) + numbers.next()) / double(starts_);
    const double u = numbers.next(), v = numbers.next();
    const EvenPoint at = points_.at(share, u, v, hint);
    const SurfacePoint& entry = at.point;
    const ArrivedLight light = light_at(input_.rays, job.lights, job.unit_emission, entry, numbers);
    double irradiance = light.irradiance[job.channel];
    if (irradiance > 0 && input_.entering_tint)
      irradiance *= double(input_.entering_tint(at.mesh, at.triangle, at.u, at.v)[job.channel]);
    if (irradiance > 0 && input_.bend) irradiance *= bent_share(entry, light, medium(job.channel).eta);
    if (!(irradiance > 0)) continue;
    Walker(*this, job.channel, exits, counts, WalkNumbers(job.seed + 1 + 2 * job.channel, start),
           WalkNumbers(job.seed + 2 + 2 * job.channel, start), irradiance)
        .arrive(inside_.at(entry), light, irradiance);
  }
  return counts;
}

}  // namespace opaline
