// SPDX-License-Identifier: GPL-3.0-or-later
// Deterministic parallel loops: fixed chunks, so results never depend on the number of threads.
#pragma once

#include <tbb/parallel_for.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cstddef>

namespace opaline {

/// Sets flush-to-zero and denormals-are-zero in a scope, as recommended by Embree, and restores the caller's
/// mode. Denormals (below 1.2e-38) in sums of exitance carry no light, but are slow.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

inline std::size_t chunk_count(std::size_t n, std::size_t chunk) {
  return (n + chunk - 1) / chunk;
}

/// Calls body(begin, end, chunk index) over [0, n) divided into chunks of the given size, in parallel, each
/// with denormals flushed. The division depends on n and chunk alone; bodies write to disjoint memory. A
/// throwing body ends the loop, but not nested loops in other running bodies, whose callers expect complete
/// results.
template <class Body>
void parallel_chunks(std::size_t n, std::size_t chunk, const Body& body) {
  tbb::task_group_context alone(tbb::task_group_context::isolated);
  tbb::parallel_for(
      std::size_t(0), chunk_count(n, chunk),
      [&](std::size_t c) {
        const FlushDenormals mode;
        body(c * chunk, std::min(n, (c + 1) * chunk), c);
      },
      tbb::simple_partitioner(), alone);
}

}  // namespace opaline
