// SPDX-License-Identifier: GPL-3.0-or-later
// Low-discrepancy points of a key (PointIrradianceInput::keys).
#pragma once

#include <bit>
#include <cstdint>

#include "core/random.h"

namespace opaline {

/// A sequence's shift, and the part of it: number of preceding points, in units of a point's rays.
struct SequencePart {
  std::uint64_t shift, part;
};

// The upper 12 bits of a key with a part; a hash may have them by chance, and is equally random then.
inline constexpr std::uint64_t kHasPart = 0xa5b;
inline constexpr int kTagBits = 12, kPartBits = 16, kShiftBits = 64 - kTagBits - kPartBits;

/// Element i of a permutation of [0, count) given by `key`.
constexpr std::uint64_t permuted(std::uint64_t i, std::uint64_t count, std::uint64_t key) {
  constexpr std::uint64_t kRounds = 4;
  const int bits = std::bit_width(count - 1), half = (bits + 1) / 2;
  const std::uint64_t mask = (std::uint64_t(1) << bits) - 1;
  do  // each step is a permutation of [0, 2^bits)
    for (std::uint64_t round = 0; round < kRounds; ++round) {
      const std::uint64_t random = hash_bits(key, round);
      i = (i ^ (random & mask)) * (random >> 32 | 1) & mask;
      i ^= i >> half;
      i = i * (random >> 16 | 1) & mask;
      i ^= i >> 1;
    }
  while (i >= count);
  return i;
}

/// Key of a camera ray within its pixel: the rays of a pixel use successive parts of one sequence, so the
/// pixel's mean has the error of all their light samples as one set. The order of parts is random for each
/// pixel: its ray positions come from the same sequence, and would correlate with light directions.
/// in    ray: the rays of a pixel have successive numbers, from a multiple of samples_per_pixel
inline std::uint64_t key_in_pixel(std::uint64_t ray, std::uint64_t samples_per_pixel) {
  if (samples_per_pixel == 1) return ray;
  const std::uint64_t pixel = ray / samples_per_pixel % (std::uint64_t(1) << kShiftBits),
                      part = permuted(ray % samples_per_pixel, samples_per_pixel, pixel) %
                             (std::uint64_t(1) << kPartBits);
  return kHasPart << (64 - kTagBits) | pixel << kPartBits | part;
}

inline SequencePart part_of(std::uint64_t key) {
  if (key >> (64 - kTagBits) != kHasPart) return {key, 0};
  return {key >> kPartBits, key & ((std::uint64_t(1) << kPartBits) - 1)};
}

}  // namespace opaline
