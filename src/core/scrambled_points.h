// SPDX-License-Identifier: GPL-3.0-or-later
// Random points: the first 2^k, and the 2^k after them, cover the unit square evenly.
#pragma once

#include <array>
#include <cstdint>

#include "core/random.h"

namespace opaline {

constexpr std::uint32_t reversed_bits(std::uint32_t bits) {
  bits = bits >> 16 | bits << 16;
  bits = (bits & 0x00ff00ffu) << 8 | (bits & 0xff00ff00u) >> 8;
  bits = (bits & 0x0f0f0f0fu) << 4 | (bits & 0xf0f0f0f0u) >> 4;
  bits = (bits & 0x33333333u) << 2 | (bits & 0xccccccccu) >> 2;
  return (bits & 0x55555555u) << 1 | (bits & 0xaaaaaaaau) >> 1;
}

/// Random permutation: the bits above a bit decide its flip (Owen scrambling). It maps each aligned block of 2^k
/// numbers to such a block.
/// in    reversed: the number with its bits reversed
/// from  Burley 2020, Practical Hash-based Owen Scrambling
constexpr std::uint32_t scrambled_from_reversed(std::uint32_t reversed, std::uint32_t seed) {
  reversed += seed;
  reversed ^= reversed * 0x6c50b47cu;
  reversed ^= reversed * 0xb82f1e52u;
  reversed ^= reversed * 0xc7afe638u;
  reversed ^= reversed * 0x8d22f6e6u;
  return reversed_bits(reversed);
}

/// Point i of the Sobol sequence in two dimensions, scrambled; uniform in [0, 1)^2 over the keys. Points of different keys
/// are independent.
/// from  Kollig & Keller 2002, Efficient Multidimensional Sampling (the sequence); Burley 2020 (its scrambling)
constexpr std::array<double, 2> scrambled_point(std::uint32_t i, std::uint64_t key) {
  const std::uint64_t seeds = hash_bits(key, 0), order = hash_bits(key, 1);
  i = scrambled_from_reversed(reversed_bits(i), std::uint32_t(order));
  std::uint32_t second = 0;
  for (std::uint32_t rest = i, direction = 1u << 31; rest != 0; rest >>= 1, direction ^= direction >> 1)
    if ((rest & 1) != 0) second ^= direction;
  return {double(scrambled_from_reversed(i, std::uint32_t(seeds))) * 0x1p-32,
          double(scrambled_from_reversed(reversed_bits(second), std::uint32_t(seeds >> 32))) * 0x1p-32};
}

}  // namespace opaline
