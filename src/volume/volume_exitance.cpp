// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/volume/volume_exitance.h"

#include <algorithm>
#include <cmath>

#include "opaline/core/parallel.h"
#include "opaline/core/random.h"
#include "opaline/lights/light.h"
#include "opaline/volume/nearest_sample.h"
#include "opaline/volume/random_walk.h"

namespace opaline {
namespace {

constexpr std::size_t kBatches = 64;      // of a pass: what the standard error comes from
constexpr std::size_t kWalksOfPass = 16;  // a sample and channel
constexpr std::size_t kTogether = 8;      // batches whose counts are held at once
constexpr double kReach = 2;  // mean free paths: a boundary beyond is met by chance, not by expectation
constexpr std::uint64_t kMostFlights = 1'000'000;

/// Points spread evenly over the area of the body.
class SurfacePoints {
 public:
  explicit SurfacePoints(const VolumeInput& input) : input_(input) {
    double sum = 0;
    for (const std::uint32_t m : input.meshes) {
      const Mesh& mesh = input.world.meshes[m];
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [i, j, k] = mesh.triangles[t];
        const Vec3d& a = mesh.positions[i];
        sum += .5 * length(cross(mesh.positions[j] - a, mesh.positions[k] - a));
        ends_.push_back(sum);
        triangles_.push_back({m, t});
      }
    }
  }

  double area() const { return ends_.back(); }

  /// share: of the area, [0, 1)
  SurfacePoint at(double share, double u, double v) const {
    const auto found = std::ranges::upper_bound(ends_, share * area());
    const auto [mesh, triangle] =
        triangles_[std::min(std::size_t(found - ends_.begin()), triangles_.size() - 1)];
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return input_.rays.surface_point(mesh, triangle, float(u), float(v));
  }

 private:
  const VolumeInput& input_;
  std::vector<double> ends_;  // running sums of areas
  std::vector<std::pair<std::uint32_t, std::uint32_t>> triangles_;
};

/// Light that has just crossed the boundary.
struct Entered {
  Vec3d direction;  // inside
  Rgb irradiance;   // W/mm^2 that enter
};

// One light, chosen by what it would bring if nothing were in its way.
Entered light_at(const VolumeInput& input, const SurfacePoint& point, WalkNumbers& numbers) {
  const float eta = float(input.media[0].eta);
  struct Choice {
    LightSample sample;
    Rgb irradiance;
    double size;
  };
  std::vector<Choice> choices;
  double sum = 0;
  for (const Light& light : input.lights) {
    const std::array<double, 2> square{numbers.next(), numbers.next()};
    const LightSample sample = sample_light(light, point.position, point.geometric, square, 1);
    const float cosine = dot(point.geometric, sample.direction);
    if (!(sample.weight > 0 && cosine > 0)) continue;
    const Rgb irradiance = emission(light) * (double(sample.weight) * cosine *
                                              fresnel_transmittance(std::min(1.0f, cosine), eta));
    choices.push_back({sample, irradiance, max_component(irradiance)});
    sum += choices.back().size;
  }
  if (!(sum > 0)) return {};
  double u = numbers.next() * sum;
  std::size_t chosen = 0;
  while (chosen + 1 < choices.size() && u >= choices[chosen].size) u -= choices[chosen++].size;
  const Choice& choice = choices[chosen];
  Ray shadow(point.position + point.geometric * input.rays.offset(point), choice.sample.direction,
             choice.sample.distance * 0.9999f);
  input.rays.occluded({&shadow, 1});
  if (shadow.far < 0 || !(choice.size > 0)) return {};
  return {refracted_inward(-Vec3d(choice.sample.direction), Vec3d(point.geometric), eta),
          choice.irradiance * (sum / choice.size)};
}

/// Where a ray from inside the body ends.
struct Wall {
  double distance = std::numeric_limits<double>::infinity();
  SurfacePoint point;
  bool is_body = false;  // or something that stops light
};

/// The inside of the body.
class Inside {
 public:
  explicit Inside(const VolumeInput& input) : input_(input), is_body_(input.world.meshes.size()) {
    for (const std::uint32_t m : input.meshes) {
      is_body_[m] = true;
      for (const Vec3d& p : input.world.meshes[m].positions)
        low_ = component_min(low_, p), high_ = component_max(high_, p);
    }
  }

  bool contains(const Vec3d& p) const {
    return p.x > low_.x && p.y > low_.y && p.z > low_.z && p.x < high_.x && p.y < high_.y && p.z < high_.z;
  }

  // Faces of the body that are met from outside lie within it where sheets cross: light goes through.
  Wall wall(const Vec3d& from, const Vec3d& direction, double reach) const {
    Wall wall;
    double gone = 0;
    for (int faces = 0; faces < 64; ++faces) {
      TracedRay traced{Ray(Vec3f(from + direction * gone), Vec3f(direction), float(reach - gone)), {}};
      input_.rays.intersect_one(traced);
      const Hit& hit = traced.hit;
      if (hit.mesh == Hit::kMiss) return wall;
      wall.point = input_.rays.surface_point(hit.mesh, hit.triangle, hit.u, hit.v);
      wall.is_body = is_body_[hit.mesh];
      const double distance = gone + double(traced.ray.far);
      if (!wall.is_body || dot(Vec3d(wall.point.geometric), direction) > 0) {
        wall.distance = distance;
        return wall;
      }
      gone = distance + double(input_.rays.offset(wall.point));
    }
    return wall;
  }

 private:
  const VolumeInput& input_;
  std::vector<bool> is_body_;
  Vec3d low_{1e300, 1e300, 1e300}, high_{-1e300, -1e300, -1e300};
};

/// One walk of one channel.
/// out   weight that was lost through holes
template <class Leave>
double walk_inside(const HomogeneousMedium& medium, const Inside& inside, const RayScene& rays,
                   const SurfacePoint& entry, WalkState walk, WalkNumbers& numbers, const Leave& leave) {
  const double albedo = medium.albedo(), least = .2 * walk.weight;
  const double reach =
      medium.sigma_t() > 0 ? kReach / medium.sigma_t() : std::numeric_limits<double>::infinity();
  const auto inward = [&](const SurfacePoint& point) {
    return Vec3d(point.position) - Vec3d(point.geometric) * double(rays.offset(point));
  };
  walk.position = inward(entry);
  for (std::uint64_t flights = 0; flights < kMostFlights; ++flights) {
    const Wall wall = inside.wall(walk.position, walk.direction, reach);
    Flight flight;
    if (std::isfinite(wall.distance)) {
      Crossing crossing = cross(medium, walk, {wall.distance, Vec3d(wall.point.geometric)});
      if (!wall.is_body) crossing.reflectance = 0;
      flight = fly(medium, walk.weight, {wall.distance, {}}, crossing, numbers);
      if (flight.leaving > 0 && wall.is_body) leave(wall.point, flight.leaving);
      walk.weight = flight.remaining;
    } else {
      // Free paths have no memory: without a collision the flight goes on from there.
      flight.distance = -std::log1p(-numbers.next()) / medium.sigma_t();
      flight.collides = flight.distance < reach;
      if (!flight.collides) flight.distance = reach;
    }
    const bool is_reflected = std::isfinite(wall.distance) && !flight.collides;
    if (is_reflected) {
      walk.position = inward(wall.point);
      walk.direction = mirrored(walk.direction, Vec3d(wall.point.geometric));
    } else {
      walk.position += walk.direction * flight.distance;
      if (!inside.contains(walk.position)) return walk.weight;
    }
    if (flight.collides) {
      walk.weight *= albedo;
      if (!survives_long(walk.weight, ++walk.collisions, numbers)) return 0;
      walk.direction = scattered(walk.direction, medium.g, numbers);
    }
    if (!survives(walk.weight, least, numbers)) return 0;
  }
  return walk.weight;
}

struct Counts {
  std::vector<Rgb> flux;  // one a sample
  Rgb lost{};
  double entered = 0;
};

/// Sums over batches, and over their squares.
struct Sums {
  std::vector<Rgb> flux, squares;
  Rgb lost{};
  double entered = 0;
  std::size_t batches = 0;

  void add(const Counts& counts) {
    for (std::size_t i = 0; i < flux.size(); ++i) {
      flux[i] += counts.flux[i];
      squares[i] += counts.flux[i] * counts.flux[i];
    }
    lost += counts.lost;
    entered += counts.entered;
    ++batches;
  }
};

class Walks {
 public:
  explicit Walks(const VolumeInput& input)
      : input_(input),
        points_(input),
        inside_(input),
        cells_(input.samples),
        starts_(std::max<std::size_t>(1, input.samples.size() * kWalksOfPass / kBatches)) {}

  Counts batch(std::size_t index) const {
    Counts counts;
    counts.flux.resize(input_.samples.size());
    for (std::size_t k = 0; k < starts_; ++k) {
      WalkNumbers numbers(input_.seed, index * starts_ + k);
      const double share = (double(k) + numbers.next()) / double(starts_);
      const double u = numbers.next(), v = numbers.next();
      const SurfacePoint entry = points_.at(share, u, v);
      const Entered entered = light_at(input_, entry, numbers);
      counts.entered += max_component(entered.irradiance);
      for (std::size_t c = 0; c < 3; ++c) {
        if (!(entered.irradiance[c] > 0) || !(input_.media[c].sigma_s > 0)) continue;
        const auto leave = [&](const SurfacePoint& point, double weight) {
          counts.flux[cells_.at(point.position, point.geometric)][c] += weight;
        };
        WalkState walk{{}, entered.direction, entered.irradiance[c], 0};
        counts.lost[c] += walk_inside(input_.media[c], inside_, input_.rays, entry, walk, numbers, leave);
      }
    }
    return counts;
  }

  /// What a walk's weight of 1 stands for, mm^2, in the mean over a batch.
  double area_of_walk() const { return points_.area() / double(starts_); }

 private:
  const VolumeInput& input_;
  SurfacePoints points_;
  Inside inside_;
  NearestSample cells_;
  std::size_t starts_;  // of a batch
};

VolumeExitance result_of(const VolumeInput& input, const Sums& sums, double area_of_walk) {
  VolumeExitance result;
  const double n = double(sums.batches);
  Rgb largest{};
  for (std::size_t i = 0; i < input.samples.size(); ++i) {
    const double scale = area_of_walk / double(input.samples[i].area);
    const Rgb mean = sums.flux[i] / n;
    Rgb error;
    for (std::size_t c = 0; c < 3; ++c) {
      error[c] = std::sqrt(std::max(0.0, sums.squares[i][c] / n - mean[c] * mean[c]) / (n - 1)) * scale;
      largest[c] = std::max(largest[c], mean[c] * scale);
    }
    result.exitance.push_back(RgbF(mean * scale));
    result.error.push_back(RgbF(error));
  }
  Rgb squares{};
  for (std::size_t i = 0; i < input.samples.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double mean = double(result.exitance[i][c]), error = double(result.error[i][c]);
      const double scale = mean * mean + 1e-4 * largest[c] * largest[c];
      if (scale > 0) squares[c] += error * error / scale;
    }
  result.relative_error = std::sqrt(max_component(squares) / double(input.samples.size()));
  result.walks = sums.batches / kBatches * kWalksOfPass;
  if (sums.entered > 0) result.lost = sums.lost / sums.entered;
  return result;
}

}  // namespace

VolumeExitance volume_exitance(const VolumeInput& input) {
  for (const HomogeneousMedium& medium : input.media) check_medium(medium);
  if (input.samples.empty()) return {};
  const Walks walks(input);
  Sums sums;
  sums.flux.resize(input.samples.size());
  sums.squares.resize(input.samples.size());
  VolumeExitance result;
  const std::size_t most = input.until_error ? kMostWalks : kDefaultWalks;
  while (result.walks < most &&
         !(input.until_error && result.walks > 0 && result.relative_error <= *input.until_error)) {
    for (std::size_t first = 0; first < kBatches; first += kTogether) {
      std::vector<Counts> counts(kTogether);
      parallel_chunks(kTogether, 1, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t b = begin; b < end; ++b) {
          counts[b] = walks.batch(sums.batches + b);
          advance(input.monitor, 1);
        }
      });
      for (const Counts& part : counts) sums.add(part);
    }
    result = result_of(input, sums, walks.area_of_walk());
  }
  return result;
}

}  // namespace opaline
