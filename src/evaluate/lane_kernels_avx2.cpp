// SPDX-License-Identifier: GPL-3.0-or-later
#include <immintrin.h>

#include "evaluate/lane_kernels.h"

#define LANES 8
#define TARGET __attribute__((target("avx2,fma")))

namespace opaline {
namespace {

typedef float V __attribute__((vector_size(32)));
typedef std::int32_t I __attribute__((vector_size(32)));

TARGET inline V lookup(const float* table, I segment) {
  return (V)_mm256_i32gather_ps(table, (__m256i)segment, 4);
}
TARGET inline V lookup_low(const float* table, I segment) {
  return lookup(table, segment);
}
TARGET inline std::uint32_t bits(I mask) {
  return std::uint32_t(_mm256_movemask_ps((__m256)mask));
}
TARGET inline bool any(I mask) {
  return bits(mask) != 0;
}

#include "evaluate/lane_kernels.inl"

}  // namespace

const LaneKernels kAvx2Kernels{"avx2", add_nodes, add_leaves};

}  // namespace opaline
