// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of plain x86-64, for lane_kernels.inl and lane_judge.inl; within the including file's namespace.

#define LANES 4
#define TARGET

typedef float V __attribute__((vector_size(16)));
typedef std::int32_t I __attribute__((vector_size(16)));

inline V lookup(const float* table, I segment) {
  return V{table[segment[0]], table[segment[1]], table[segment[2]], table[segment[3]]};
}
[[maybe_unused]] inline V lookup_32(const float* table, I segment) {
  return lookup(table, segment);
}
[[maybe_unused]] inline V lookup_16(const float* table, I segment) {
  return lookup(table, segment);
}
[[maybe_unused]] inline V square_root(V v) {
  return (V)_mm_sqrt_ps((__m128)v);
}
inline std::uint32_t bits(I mask) {
  return std::uint32_t(_mm_movemask_ps((__m128)mask));
}
[[maybe_unused]] inline bool any(I mask) {
  return bits(mask) != 0;
}
[[maybe_unused]] inline bool any_less(V a, V b) {
  return any(a < b);
}
[[maybe_unused]] inline float total(V v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}
