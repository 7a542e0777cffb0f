// SPDX-License-Identifier: GPL-3.0-or-later
// Precomputed random walks from the centre of a sphere to its surface, reused deep inside a body.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "transport/walk_numbers.h"

namespace opaline {

/// Pool of walks in spheres. With isotropic scattering, a walk just scattered leaves a sphere around it
/// uniformly over its surface; the number of collisions and the exit angle depend on the radius in mean free
/// paths alone. A random element of a random pool is an unbiased sample.
class SphereExits {
 public:
  struct Exit {
    float cosine;              ///< cosine of the direction with the outward normal, > 0
    std::uint32_t collisions;  ///< in the sphere; the last flight ends at the surface
  };

  static constexpr std::array<double, 3> kRadii{2, 4, 8};  ///< mean free paths
  static constexpr std::size_t kSizes = kRadii.size();

  /// exits: per radius
  SphereExits(std::size_t exits, std::uint64_t seed);

  const Exit& any(std::size_t size, WalkNumbers& numbers) const {
    return pools_[size][std::size_t(numbers.next() * double(pools_[size].size()))];
  }

 private:
  std::array<std::vector<Exit>, kSizes> pools_;
};

}  // namespace opaline
