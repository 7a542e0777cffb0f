// SPDX-License-Identifier: GPL-3.0-or-later
// Which low-discrepancy points a key chooses (PointIrradianceInput::keys).
#pragma once

#include <cstdint>

namespace opaline {

/// A sequence's shift, and the part of it: so many points of the sequence come before, in units of a point's rays.
struct SequencePart {
  std::uint64_t shift, part;
};

inline constexpr std::uint64_t kOfPixel = std::uint64_t(1) << 63;
inline constexpr int kPartBits = 16;

/// The key of a camera ray among those of its pixel: together they take successive parts of one sequence, so that the
/// pixel's mean has the error of all their light samples as one set.
/// in    ray: the rays of a pixel are numbered one after the other, from a multiple of samples_per_pixel
inline std::uint64_t key_in_pixel(std::uint64_t ray, std::uint64_t samples_per_pixel) {
  return kOfPixel | ray / samples_per_pixel << kPartBits | ray % samples_per_pixel;
}

/// Any other key is a sequence of its own; one that is a hash may have the bit of a pixel's, and is as random then.
inline SequencePart part_of(std::uint64_t key) {
  if ((key & kOfPixel) == 0) return {key, 0};
  return {key >> kPartBits, key & ((std::uint64_t(1) << kPartBits) - 1)};
}

}  // namespace opaline
