// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of AVX2 with FMA, for lane_kernels.inl and lane_judge.inl; within the including file's namespace.

#define LANES 8
#define TARGET __attribute__((target("avx2,fma")))

typedef float V __attribute__((vector_size(32)));
typedef std::int32_t I __attribute__((vector_size(32)));

TARGET inline V lookup(const float* table, I segment) {
  return (V)_mm256_i32gather_ps(table, (__m256i)segment, 4);
}
[[maybe_unused]] TARGET inline V lookup_32(const float* table, I segment) {
  return lookup(table, segment);
}
[[maybe_unused]] TARGET inline V lookup_16(const float* table, I segment) {
  const __m256i index = (__m256i)segment;
  const __m256 low = _mm256_permutevar8x32_ps(_mm256_load_ps(table), index),
               high = _mm256_permutevar8x32_ps(_mm256_load_ps(table + 8), index);
  return (V)_mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(index, 28)));
}
[[maybe_unused]] TARGET inline V square_root(V v) {
  return (V)_mm256_sqrt_ps((__m256)v);
}
TARGET inline std::uint32_t bits(I mask) {
  return std::uint32_t(_mm256_movemask_ps((__m256)mask));
}
[[maybe_unused]] TARGET inline bool any(I mask) {
  return bits(mask) != 0;
}
[[maybe_unused]] TARGET inline bool any_less(V a, V b) {
  return any(a < b);
}
[[maybe_unused]] TARGET inline float total(V v) {
  __m128 half = _mm_add_ps(_mm256_castps256_ps128((__m256)v), _mm256_extractf128_ps((__m256)v, 1));
  half = _mm_add_ps(half, _mm_movehl_ps(half, half));
  return _mm_cvtss_f32(_mm_add_ss(half, _mm_shuffle_ps(half, half, 1)));
}
