// SPDX-License-Identifier: GPL-3.0-or-later
// Walks from the centre of a sphere to its surface, made once and used by many walks deep inside a body.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "transport/walk_numbers.h"

namespace opaline {

/// Where scattering is even, a walk that has just been scattered leaves a sphere around it anywhere, with equal chance
/// all around; in how many collisions, and at which angle, depends on the radius in mean free paths alone. A pool of
/// such walks is an unbiased sample of them, and so is one drawn from it at random.
class SphereExits {
 public:
  struct Exit {
    float cosine;              ///< cosine of the direction with the outward normal, > 0
    std::uint32_t collisions;  ///< on the way; the last flight ends at the surface
  };

  static constexpr std::array<double, 3> kRadii{2, 4, 8};  ///< mean free paths
  static constexpr std::size_t kSizes = kRadii.size();

  /// exits: of each size
  SphereExits(std::size_t exits, std::uint64_t seed);

  const Exit& any(std::size_t size, WalkNumbers& numbers) const {
    return pools_[size][std::size_t(numbers.next() * double(pools_[size].size()))];
  }

 private:
  std::array<std::vector<Exit>, kSizes> pools_;
};

}  // namespace opaline
