// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks of light inside a body: free flights, collisions, and exits.
//
// A walk carries a weight, its fraction of the light. Exits at the boundary are counted by expected value,
// absorption reduces the weight, and Russian roulette ends walks without bias. Derived in
// src/transport/README.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "opaline/vec3.h"
#include "transport/henyey_greenstein.h"
#include "transport/medium.h"
#include "transport/smooth_boundary.h"
#include "transport/walk_numbers.h"

namespace opaline {

struct WalkState {
  Vec3d position;   ///< mm
  Vec3d direction;  ///< unit, of propagation
  double weight = 1;
  std::uint64_t collisions = 0;
};

/// Next boundary along a ray.
struct BoundaryAhead {
  double distance = std::numeric_limits<double>::infinity();  ///< mm, >= 0
  Vec3d normal;                                               ///< unit, outward
};

/// Interaction of a ray with the medium up to the boundary, and with the boundary.
struct Crossing {
  double collided = 0;     ///< fraction colliding before the boundary, 1 - exp(-sigma_t distance)
  double reflectance = 0;  ///< reflectance of the boundary, for the rest
};

inline Crossing cross(const HomogeneousMedium& medium, const WalkState& walk, const BoundaryAhead& ahead) {
  const double collided = -std::expm1(-medium.sigma_t() * ahead.distance);
  if (collided == 1) return {1, 1};
  return {collided, inside_reflectance(dot(walk.direction, ahead.normal), medium.eta)};
}

/// One flight: the exiting weight, and the continuing walk.
struct Flight {
  double leaving = 0;    ///< weight crossing the boundary
  double remaining = 0;  ///< continuing weight
  double distance = 0;   ///< to the point of continuation: a collision, or a reflection at the boundary
  bool collides = false;
};

inline Flight fly(const HomogeneousMedium& medium, double weight, const BoundaryAhead& ahead,
                  const Crossing& crossing, WalkNumbers& numbers) {
  const double leaving = (1 - crossing.collided) * (1 - crossing.reflectance), remaining = 1 - leaving;
  Flight flight{weight * leaving, weight * remaining, ahead.distance, false};
  const double share = numbers.next() * remaining;  // below `collided` it is the free path's distribution
  flight.collides = share < crossing.collided;
  if (flight.collides) flight.distance = std::min(ahead.distance, -std::log1p(-share) / medium.sigma_t());
  return flight;
}

/// Russian roulette: ends a walk of weight `least` or below, or continues it with twice that; keeps the mean.
inline bool survives(double& weight, double least, WalkNumbers& numbers) {
  if (weight > least) return true;
  if (numbers.next() * 2 * least >= weight) return false;
  weight = 2 * least;
  return true;
}

/// Ends half of all walks reaching 1024, 4096, 16384, ... collisions; the others get twice the weight.
inline bool survives_long(double& weight, std::uint64_t collisions, WalkNumbers& numbers) {
  constexpr std::uint64_t kFirst = 1024, kEvenBits = 0x5555555555555555u;
  const bool is_power_of_two = (collisions & (collisions - 1)) == 0;
  if (collisions < kFirst || !is_power_of_two || (collisions & kEvenBits) == 0) return true;
  weight *= 2;
  return numbers.next() < .5;
}

/// The same for several collisions at once; `collisions` becomes their sum.
inline bool survives_long(double& weight, std::uint64_t& collisions, std::uint64_t more,
                          WalkNumbers& numbers) {
  constexpr std::uint64_t kFirst = 1024;
  std::uint64_t next = kFirst;
  while (next <= collisions) next *= 4;
  collisions += more;
  for (; next <= collisions; next *= 4) {
    weight *= 2;
    if (numbers.next() >= .5) return false;
  }
  return true;
}

/// In mean free paths.
inline double free_path(WalkNumbers& numbers) {
  return -std::log(1 - numbers.next());
}

/// Uniform over the sphere (Marsaglia 1972).
inline Vec3d even_direction(WalkNumbers& numbers) {
  for (;;) {
    const auto [x, y] = numbers.next_pair();
    const double s = x * x + y * y, k = 2 * std::sqrt(std::max(0.0, 1 - s));
    if (s < 1) return {x * k, y * k, 1 - 2 * s};
  }
}

inline Vec3d scattered(const Vec3d& direction, double g, WalkNumbers& numbers) {
  const double cosine = sample_henyey_greenstein(g, numbers.next());
  return deflected(direction, cosine, numbers.next_angle());
}

/// Light crossing the boundary from inside; it continues as refracted_outward(direction, normal, eta).
struct WalkExit {
  Vec3d position, direction;  ///< on the boundary; inside, before the refraction
  Vec3d normal;
  double weight = 0;
  std::uint64_t collisions = 0;  ///< before it left; 0: unscattered
};

/// Weight of a walk that did not exit.
struct WalkEnd {
  double absorbed = 0;
  double unfinished = 0;  ///< weight inside at the end of an unfinished walk
};

/// Follows one walk to its end; `walk` then has its last state.
/// in    body.ahead(position, direction): BoundaryAhead of a ray starting inside
///       watcher.visit(walk, ahead, crossing): called before every flight
///       watcher.leave(WalkExit): called at every exit
///       most_collisions: maximum, ending the walk unfinished
/// out   mean over walks: exited weight + absorbed + unfinished = weight at the start
template <class Body, class Watcher>
WalkEnd random_walk(const HomogeneousMedium& medium, const Body& body, std::uint64_t most_collisions,
                    WalkNumbers& numbers, WalkState& walk, Watcher&& watcher) {
  constexpr double kLeastShare = .2;
  const bool is_empty = !(medium.sigma_t() > 0);
  const double albedo = medium.albedo(), absorbed = is_empty ? 0 : medium.sigma_a / medium.sigma_t();
  const double least = kLeastShare * walk.weight;
  WalkEnd end;
  for (;;) {
    const BoundaryAhead ahead = body.ahead(walk.position, walk.direction);
    const bool is_endless = is_empty && !std::isfinite(ahead.distance);
    if (is_endless || walk.collisions >= most_collisions) {
      end.unfinished = walk.weight;
      return end;
    }
    const Crossing crossing = cross(medium, walk, ahead);
    watcher.visit(walk, ahead, crossing);
    const Flight flight = fly(medium, walk.weight, ahead, crossing, numbers);
    if (flight.leaving > 0)
      watcher.leave(WalkExit{walk.position + walk.direction * ahead.distance, walk.direction, ahead.normal,
                             flight.leaving, walk.collisions});
    walk.position += walk.direction * flight.distance;
    walk.weight = flight.remaining;
    if (flight.collides) {
      ++walk.collisions;
      end.absorbed += walk.weight * absorbed;
      walk.weight *= albedo;
      if (!survives_long(walk.weight, walk.collisions, numbers)) return end;
    }
    if (!survives(walk.weight, least, numbers)) return end;
    walk.direction = flight.collides ? scattered(walk.direction, medium.g, numbers)
                                     : mirrored(walk.direction, ahead.normal);
  }
}

}  // namespace opaline
