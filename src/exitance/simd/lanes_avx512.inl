// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of AVX-512F, for lane_kernels.inl and lane_judge.inl; within the including file's namespace.

#define LANES 16
#define TARGET __attribute__((target("avx512f,fma")))

typedef float V __attribute__((vector_size(64)));
typedef std::int32_t I __attribute__((vector_size(64)));

TARGET inline V lookup(const float* table, I segment) {
  const __m512i index = (__m512i)segment;
  const __m512 low = _mm512_permutex2var_ps(_mm512_load_ps(table), index, _mm512_load_ps(table + 16));
  const __m512 high = _mm512_permutex2var_ps(_mm512_load_ps(table + 32), index, _mm512_load_ps(table + 48));
  return (V)_mm512_mask_blend_ps(_mm512_test_epi32_mask(index, _mm512_set1_epi32(32)), low, high);
}

[[maybe_unused]] TARGET inline V lookup_32(const float* table, I segment) {
  return (V)_mm512_permutex2var_ps(_mm512_load_ps(table), (__m512i)segment, _mm512_load_ps(table + 16));
}

[[maybe_unused]] TARGET inline V lookup_16(const float* table, I segment) {
  return (V)_mm512_maskz_permutexvar_ps(__mmask16(-1), (__m512i)segment, _mm512_load_ps(table));
}
[[maybe_unused]] TARGET inline V square_root(V v) {
  return (V)_mm512_maskz_sqrt_ps(__mmask16(-1), (__m512)v);
}
TARGET inline std::uint32_t bits(I mask) {
  return _mm512_test_epi32_mask((__m512i)mask, (__m512i)mask);
}
[[maybe_unused]] TARGET inline bool any(I mask) {
  return bits(mask) != 0;
}
// GCC would make a vector of the comparison first.
[[maybe_unused]] TARGET inline bool any_less(V a, V b) {
  return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ) != 0;
}
[[maybe_unused]] TARGET inline float total(V v) {
  alignas(64) float lanes[16];
  _mm512_store_ps(lanes, (__m512)v);
  __m128 sum = _mm_add_ps(_mm_add_ps(_mm_load_ps(lanes), _mm_load_ps(lanes + 8)),
                          _mm_add_ps(_mm_load_ps(lanes + 4), _mm_load_ps(lanes + 12)));
  sum = _mm_add_ps(sum, _mm_movehl_ps(sum, sum));
  return _mm_cvtss_f32(_mm_add_ss(sum, _mm_shuffle_ps(sum, sum, 1)));
}
