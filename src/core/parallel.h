// SPDX-License-Identifier: GPL-3.0-or-later
// Deterministic parallel loops: fixed chunks, so results never depend on the number of threads.
#pragma once

#include <tbb/parallel_for.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cstddef>

namespace opaline {

/// Sets flush-to-zero and denormals-are-zero for a scope, as Embree asks, and restores the caller's mode.
/// Denormals (below 1.2e-38) in sums of exitance carry no light; without this an underflowing exp stalls.
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

/// Calls body(begin, end, chunk index) over [0, n) cut into chunks of the given size, in parallel, each with
/// denormals flushed. The cut depends on n and chunk alone; bodies write to places of their own. A body that throws ends
/// the loop, but none within other bodies that are running: whoever called those takes their results for whole.
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
