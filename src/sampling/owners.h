// SPDX-License-Identifier: GPL-3.0-or-later
// Candidate owners of parts of a triangle's piece.
#pragma once

#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sampling/flat_piece.h"

namespace opaline {

/// A sample possibly owning part of a piece.
struct Owner {
  static constexpr std::uint32_t kNone = ~0u;
  std::uint32_t sample = kNone;
  float sum = INFINITY;                    // sum of the squared distances
  __m128 squared = _mm_set1_ps(INFINITY);  // distances from the piece's corners

  Owner() = default;
  Owner(std::uint32_t sample_, float sum_, __m128 squared_) : sample(sample_), sum(sum_), squared(squared_) {}
  bool is_none() const { return sample == kNone; }
};

template <std::size_t kCorners>
Owner make_owner(const FlatPiece<kCorners>& piece, std::uint32_t sample, const Vec3f& position) {
  const __m128 squared = piece.squared_distances(position);
  alignas(16) std::array<float, 4> s;
  _mm_store_ps(s.data(), squared);
  float sum = s[0] + s[1] + s[2];
  if constexpr (kCorners == 4) sum += s[3];
  return {sample, sum, squared};
}

/// True if a is nearer to all corners, hence to all points of the piece.
template <std::size_t kCorners>
bool dominates(__m128 a, __m128 b) {
  constexpr int all = (1 << kCorners) - 1;
  return (_mm_movemask_ps(_mm_cmplt_ps(a, b)) & all) == all;
}

/// Removes dominated owners, from `first` on; searches dominating ones among the nearest to each corner and
/// to the centre.
template <std::size_t kCorners>
void remove_dominated(std::vector<Owner>& owners, std::size_t first) {
  __m128 least = owners[first].squared;
  std::array<std::size_t, kCorners + 1> best;
  best.fill(first);
  for (std::size_t i = first + 1; i < owners.size(); ++i) {
    const auto less = unsigned(_mm_movemask_ps(_mm_cmplt_ps(owners[i].squared, least)));
    least = _mm_min_ps(least, owners[i].squared);
    for (std::size_t k = 0; k < kCorners; ++k) best[k] = less >> k & 1 ? i : best[k];
    best[kCorners] = owners[i].sum < owners[best[kCorners]].sum ? i : best[kCorners];
  }
  std::array<Owner, kCorners + 1> nearest;
  for (std::size_t k = 0; k <= kCorners; ++k) nearest[k] = owners[best[k]];
  const auto is_dominated = [&nearest](const Owner& o) {
    bool dominated = false;
    for (const Owner& n : nearest) dominated |= dominates<kCorners>(n.squared, o.squared);
    return dominated;
  };
  owners.erase(std::remove_if(owners.begin() + std::ptrdiff_t(first), owners.end(), is_dominated),
               owners.end());
}

/// Sorts the owners from `first` on by their sums of squared distances, as integers with the sum in the upper
/// half and the sample in the lower: non-negative floats sort like integers, and integers move faster.
inline void nearest_first(const std::vector<Owner>& owners, std::size_t first,
                          std::vector<std::uint64_t>& sorted) {
  sorted.clear();
  for (std::size_t i = first; i < owners.size(); ++i)
    sorted.push_back(std::uint64_t(std::bit_cast<std::uint32_t>(owners[i].sum)) << 32 | owners[i].sample);
  std::ranges::sort(sorted);
}

}  // namespace opaline
