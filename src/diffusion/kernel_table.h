// SPDX-License-Identifier: GPL-3.0-or-later
// R_d(r) of three channels as a table of cubics in r^2, four floats at a time.
#pragma once

#include <emmintrin.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "diffusion/diffuse_profile.h"

namespace opaline {

/// R_d as piecewise cubics in s = (r / r_max)^2, 32 segments an octave of s, found from the bits of s.
/// Between r_min and r_max the error is below 4e-6 of R_d wherever R_d is above 1e-9 of its largest value.
/// Below r_min the table has the value at r_min, beyond r_max it is 0; the range is widened outward to whole
/// octaves of s. Powers of two scale through it exactly.
class KernelTable {
 public:
  KernelTable() = default;
  /// r_min, r_max in mm: range of distances in use; the table ends earlier if R_d underflows.
  KernelTable(const DiffuseProfile& profile, double r_min, double r_max);
  /// The same of far_side_profile.
  static KernelTable of_far_side(const DiffuseProfile& profile, double r_min, double r_max);

  /// (R, G, B, 0) at one squared distance, mm^2.
  __m128 operator()(float r2) const {
    const Segment& segment = *find(r2);
    return cubic(segment.c0, segment.c1, segment.c2, segment.c3, _mm_set1_ps(offset(r2)));
  }

  /// R at the first, G at the second, B at the third squared distance, mm^2.
  __m128 operator()(float r2_r, float r2_g, float r2_b) const {
    const Segment &r = *find(r2_r), &g = *find(r2_g), &b = *find(r2_b);
    const auto gather = [&](__m128 Segment::*c) {
      return _mm_setr_ps((r.*c)[0], (g.*c)[1], (b.*c)[2], 0.0f);
    };
    return cubic(gather(&Segment::c0), gather(&Segment::c1), gather(&Segment::c2), gather(&Segment::c3),
                 _mm_setr_ps(offset(r2_r), offset(r2_g), offset(r2_b), 0.0f));
  }

  /// Memory of the table.
  std::size_t bytes() const { return segments_.size() * sizeof(Segment); }

 private:
  struct alignas(64) Segment {
    __m128 c0, c1, c2, c3;  // lanes R, G, B, 0
  };
  static constexpr int kSegmentBits = 5;
  static constexpr std::uint32_t kFractionBits = 23 - kSegmentBits;

  using Kernel = double (*)(const ChannelProfile&, double);
  KernelTable(const DiffuseProfile& profile, Kernel kernel, double r_min, double r_max);

  float clamped(float r2) const {
    const float s = r2 * inverse_scale2_;
    return s < s_min_ ? s_min_ : s < s_max_ ? s : s_max_;
  }
  const Segment* find(float r2) const {
    return segments_.data() + ((std::bit_cast<std::uint32_t>(clamped(r2)) >> kFractionBits) - first_);
  }
  float offset(float r2) const {
    const std::uint32_t fraction = std::bit_cast<std::uint32_t>(clamped(r2)) & ((1u << kFractionBits) - 1);
    return float(fraction) * (1.0f / float(1u << kFractionBits));
  }
  static __m128 cubic(__m128 c0, __m128 c1, __m128 c2, __m128 c3, __m128 t) {
    const __m128 upper = _mm_add_ps(c2, _mm_mul_ps(c3, t));
    return _mm_add_ps(c0, _mm_mul_ps(t, _mm_add_ps(c1, _mm_mul_ps(t, upper))));
  }

  std::vector<Segment> segments_;
  float inverse_scale2_ = 1, s_min_ = 0, s_max_ = 0;
  std::uint32_t first_ = 0;
};

}  // namespace opaline
