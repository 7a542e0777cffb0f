// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/sphere_exits.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "transport/random_walk.h"

namespace opaline {
namespace {

SphereExits::Exit walked_out(double radius, WalkNumbers& numbers) {
  constexpr std::uint32_t kMost = 100000;  // far beyond any practical probability
  Vec3d position{}, direction = even_direction(numbers);
  for (std::uint32_t collisions = 0;; ++collisions) {
    const double flight = free_path(numbers), along = dot(position, direction);
    const double inside = radius * radius - dot(position, position);
    const double to_surface = std::sqrt(std::max(0.0, along * along + inside)) - along;
    if (flight >= to_surface || collisions == kMost) {
      const double cosine = dot(position + direction * to_surface, direction) / radius;
      return {float(std::clamp(cosine, 1e-6, 1.0)), collisions};
    }
    position += direction * flight;
    direction = even_direction(numbers);
  }
}

}  // namespace

SphereExits::SphereExits(std::size_t exits, std::uint64_t seed) {
  for (std::size_t s = 0; s < kSizes; ++s) {
    pools_[s].resize(exits);
    parallel_chunks(exits, 256, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        WalkNumbers numbers(seed, s * exits + i);
        pools_[s][i] = walked_out(kRadii[s], numbers);
      }
    });
  }
}

}  // namespace opaline
