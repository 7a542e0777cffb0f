// SPDX-License-Identifier: GPL-3.0-or-later
// Which low-discrepancy points a key chooses (PointIrradianceInput::keys).
#pragma once

#include <cstdint>

namespace opaline {

/// A sequence's shift, and the part of it: so many points of the sequence come before, in units of a point's rays.
struct SequencePart {
  std::uint64_t shift, part;
};

// The upper 12 bits of a key that has a part; a key that is a hash has them by chance, and is as random then.
inline constexpr std::uint64_t kHasPart = 0xa5b;
inline constexpr int kTagBits = 12, kPartBits = 16, kShiftBits = 64 - kTagBits - kPartBits;

/// The key of a camera ray among those of its pixel: together they take successive parts of one sequence, so that the
/// pixel's mean has the error of all their light samples as one set.
/// in    ray: the rays of a pixel are numbered one after the other, from a multiple of samples_per_pixel
inline std::uint64_t key_in_pixel(std::uint64_t ray, std::uint64_t samples_per_pixel) {
  if (samples_per_pixel == 1) return ray;
  const std::uint64_t pixel = ray / samples_per_pixel % (std::uint64_t(1) << kShiftBits),
                      part = ray % samples_per_pixel % (std::uint64_t(1) << kPartBits);
  return kHasPart << (64 - kTagBits) | pixel << kPartBits | part;
}

inline SequencePart part_of(std::uint64_t key) {
  if (key >> (64 - kTagBits) != kHasPart) return {key, 0};
  return {key >> kPartBits, key & ((std::uint64_t(1) << kPartBits) - 1)};
}

}  // namespace opaline
