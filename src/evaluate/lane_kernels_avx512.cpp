// SPDX-License-Identifier: GPL-3.0-or-later
#include <immintrin.h>

#include "evaluate/lane_kernels.h"

#define LANES 16
#define TARGET __attribute__((target("avx512f,fma")))

namespace opaline {
namespace {

typedef float V __attribute__((vector_size(64)));
typedef std::int32_t I __attribute__((vector_size(64)));

TARGET inline V lookup(const float* table, I segment) {
  const __m512i index = (__m512i)segment;
  const __m512 low = _mm512_permutex2var_ps(_mm512_load_ps(table), index, _mm512_load_ps(table + 16));
  const __m512 high = _mm512_permutex2var_ps(_mm512_load_ps(table + 32), index, _mm512_load_ps(table + 48));
  return (V)_mm512_mask_blend_ps(_mm512_test_epi32_mask(index, _mm512_set1_epi32(32)), low, high);
}

TARGET inline V lookup_low(const float* table, I segment) {
  return (V)_mm512_permutex2var_ps(_mm512_load_ps(table), (__m512i)segment, _mm512_load_ps(table + 16));
}

TARGET inline std::uint32_t bits(I mask) {
  return _mm512_test_epi32_mask((__m512i)mask, (__m512i)mask);
}
TARGET inline bool any(I mask) {
  return bits(mask) != 0;
}

#include "evaluate/lane_kernels.inl"

}  // namespace

const LaneKernels kAvx512Kernels{"avx512", add_nodes, add_leaves};

}  // namespace opaline
