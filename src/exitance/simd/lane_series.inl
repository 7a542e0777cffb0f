// SPDX-License-Identifier: GPL-3.0-or-later
// The far kernel and its derivatives on vectors of LANES floats, looked up: the first part of
// lane_kernels.inl.

TARGET static inline V splat(float f) {
  return V{} + f;
}
TARGET static inline V load(const float* p) {
  V v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
TARGET static inline void store(float* p, V v) {
  __builtin_memcpy(p, &v, sizeof v);
}
TARGET static inline void add_to(float* p, V v) {
  store(p, load(p) + v);
}
TARGET static inline V larger(V a, V b) {
  return a > b ? a : b;
}
TARGET static inline V smaller(V a, V b) {
  return a < b ? a : b;
}

// Position of q in the table.
struct Place {
  I segment;
  V t;              // relative position along it
  V inverse_width;  // inverse width of the segment, in q
};

TARGET static inline Place find(V q) {
  constexpr std::int32_t kOne = 0x3F800000, kFraction = 0x003FFFFF;
  const I bits = (I)q;
  const I segment = (bits - kOne) >> 22, last = I{} + (LaneTable::kSegments - 1);
  const I octave = bits & 0x7F800000;
  return {segment > last ? last : segment, __builtin_convertvector(bits & kFraction, V) * 0x1p-22f,
          (V)(0x7F800000 - octave)};
}

using Channel = std::array<std::array<float, LaneTable::kSegments>, 4>;
using Curvature = std::array<std::array<float, LaneTable::kSegments>, 3>;

// Range of the table in use: to 4 h, to 64 h, unlimited.
enum class Reach { near, middle, all };

template <Reach reach>
TARGET static inline V lookup_within(const float* table, I segment) {
  if constexpr (reach == Reach::near) return lookup_16(table, segment);
  if constexpr (reach == Reach::middle) return lookup_32(table, segment);
  return lookup(table, segment);
}

template <Reach reach>
TARGET static inline V kernel(const Channel& channel, const Place& at) {
  const V c0 = lookup_within<reach>(channel[0].data(), at.segment),
          c1 = lookup_within<reach>(channel[1].data(), at.segment),
          c2 = lookup_within<reach>(channel[2].data(), at.segment),
          c3 = lookup_within<reach>(channel[3].data(), at.segment);
  return c0 + at.t * (c1 + at.t * (c2 + at.t * c3));
}

// Kernels of three channels.
struct Kernels {
  V c0, c1, c2;
};

template <Reach reach>
TARGET static inline Kernels kernels(const LaneTable& table, const Place& at) {
  return {kernel<reach>(table.coefficients[0], at), kernel<reach>(table.coefficients[1], at),
          kernel<reach>(table.coefficients[2], at)};
}

// The kernel and its derivatives in q.
struct Series {
  V value, first, second;
};

template <Reach reach>
TARGET static inline Series series(const LaneTable& table, std::size_t channel, const Place& at) {
  const Channel& c = table.coefficients[channel];
  const Curvature& d = table.curvature[channel];
  const V c0 = lookup_within<reach>(c[0].data(), at.segment),
          c1 = lookup_within<reach>(c[1].data(), at.segment),
          c2 = lookup_within<reach>(c[2].data(), at.segment),
          c3 = lookup_within<reach>(c[3].data(), at.segment),
          d0 = lookup_within<reach>(d[0].data(), at.segment),
          d1 = lookup_within<reach>(d[1].data(), at.segment),
          d2 = lookup_within<reach>(d[2].data(), at.segment);
  return {c0 + at.t * (c1 + at.t * (c2 + at.t * c3)),
          (c1 + at.t * (2 * c2 + 3 * at.t * c3)) * at.inverse_width, d0 + at.t * (d1 + at.t * d2)};
}

TARGET static inline Series series(const LaneTable& table, std::size_t channel, const Place& at) {
  return any(at.segment > 31) ? series<Reach::all>(table, channel, at)
                              : series<Reach::middle>(table, channel, at);
}

// Relative change to second order; limited to the range of the series.
TARGET static inline V relative_change(V value, V change) {
  return smaller(larger(change / larger(value, splat(1e-37f)), splat(-0.5f)), splat(0.35f));
}

// Estimates the fourth order of a series in the samples' offsets from the second: 0.9 of its square for a
// power law 1/r^3 and a flat patch, a third for exponentials.
TARGET static inline V with_fourth_order(V value, V change) {
  return value + change * (1 + 0.8f * relative_change(value, change));
}

// Sum of the kernel over a node with second moment C around its centroid at d: F(s) + F' tr C + 2 F'' d'Cd, s
// = d'd. Limited to a quarter and four times F: nearby, and far down an exponential, the series diverges.
TARGET static inline V node_kernel(const LaneTable& table, std::size_t channel, const Place& at, V first,
                                   V second) {
  const Series f = series(table, channel, at);
  const V corrected = with_fourth_order(f.value, f.first * first + f.second * second);
  return smaller(larger(corrected, 0.25f * f.value), 4.0f * f.value);
}
