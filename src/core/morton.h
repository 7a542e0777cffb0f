// SPDX-License-Identifier: GPL-3.0-or-later
// Integer Morton keys: near keys are near in space.
#pragma once

#include <cstdint>

namespace opaline {

/// Spreads the low 21 bits of v to every third bit.
constexpr std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | v << 32) & 0x001F00000000FFFFull;
  v = (v | v << 16) & 0x001F0000FF0000FFull;
  v = (v | v << 8) & 0x100F00F00F00F00Full;
  v = (v | v << 4) & 0x10C30C30C30C30C3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

/// Interleaves 21 bits of each coordinate, x lowest.
constexpr std::uint64_t morton_key(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

/// The inverse of spread_bits: every third bit of v, from the lowest.
constexpr std::uint32_t gather_bits(std::uint64_t v) {
  v &= 0x1249249249249249ull;
  v = (v | v >> 2) & 0x10C30C30C30C30C3ull;
  v = (v | v >> 4) & 0x100F00F00F00F00Full;
  v = (v | v >> 8) & 0x001F0000FF0000FFull;
  v = (v | v >> 16) & 0x001F00000000FFFFull;
  return std::uint32_t((v | v >> 32) & 0x1FFFFF);
}

}  // namespace opaline
