// SPDX-License-Identifier: GPL-3.0-or-later
// The samples that may own parts of a piece of a triangle.
#pragma once

#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace opaline {

/// A sample that may own part of a piece.
struct Owner {
  static constexpr std::uint32_t kNone = ~0u;
  std::uint32_t sample = kNone;
  float sum = INFINITY;                    // of the squared distances
  __m128 squared = _mm_set1_ps(INFINITY);  // distances from the piece's corners

  Owner() = default;
  Owner(std::uint32_t sample_, __m128 squared_) : sample(sample_), squared(squared_) {
    alignas(16) std::array<float, 4> s;
    _mm_store_ps(s.data(), squared);
    sum = s[0] + s[1] + s[2];
  }
  bool is_none() const { return sample == kNone; }
};

/// Nearer to all corners, and with that to all that lies between them.
inline bool dominates(__m128 a, __m128 b) {
  return (_mm_movemask_ps(_mm_cmplt_ps(a, b)) & 7) == 7;
}

/// Removes those owners, from `first` on, that another one dominates; it is sought among the nearest to each
/// corner and to the centre.
inline void remove_dominated(std::vector<Owner>& owners, std::size_t first) {
  __m128 least = owners[first].squared;
  std::array<std::size_t, 4> best;
  best.fill(first);
  for (std::size_t i = first + 1; i < owners.size(); ++i) {
    const auto less = unsigned(_mm_movemask_ps(_mm_cmplt_ps(owners[i].squared, least)));
    least = _mm_min_ps(least, owners[i].squared);
    for (std::size_t k = 0; k < 3; ++k) best[k] = less >> k & 1 ? i : best[k];
    best[3] = owners[i].sum < owners[best[3]].sum ? i : best[3];
  }
  const std::array<Owner, 4> nearest{owners[best[0]], owners[best[1]], owners[best[2]], owners[best[3]]};
  const auto is_dominated = [&nearest](const Owner& o) {
    bool dominated = false;
    for (const Owner& n : nearest) dominated |= dominates(n.squared, o.squared);
    return dominated;
  };
  owners.erase(std::remove_if(owners.begin() + std::ptrdiff_t(first), owners.end(), is_dominated),
               owners.end());
}

/// The owners from `first` on by the sum of their squared distances, in the upper half of each value; the
/// sample is in the lower. As integers, which order like the floats they stand for and are moved at less
/// cost.
inline void nearest_first(const std::vector<Owner>& owners, std::size_t first,
                          std::vector<std::uint64_t>& sorted) {
  sorted.clear();
  for (std::size_t i = first; i < owners.size(); ++i)
    sorted.push_back(std::uint64_t(std::bit_cast<std::uint32_t>(owners[i].sum)) << 32 | owners[i].sample);
  std::ranges::sort(sorted);
}

}  // namespace opaline
