// SPDX-License-Identifier: GPL-3.0-or-later
// The sum over far nodes and samples at one query point, and its near field.
#pragma once

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "opaline/evaluate/evaluate.h"
#include "opaline/sampling/sample_surface.h"

namespace opaline {

class Gather {
 public:
  Gather(const EvaluateInput& input, const Query& query)
      : octree_(input.octree),
        kernel_(input.kernel),
        query_(query),
        near2_(input.kernel.radius * input.kernel.radius),
        noise_(float(input.irradiance_noise)) {}

  /// A node beyond the near field, lanes of r2 the squared distances of its centroids.
  void add_node(const OctreeNode& node, __m128 r2) {
    alignas(16) float d[4];
    _mm_store_ps(d, r2);
    // Lights of one colour give all channels the same centroid.
    const __m128 k = d[0] == d[1] && d[1] == d[2] ? kernel_.table(d[0]) : kernel_.table(d[0], d[1], d[2]);
    const __m128 contribution = _mm_mul_ps(k, _mm_load_ps(node.flux.data()));
    accumulate(contribution);
    // What a point in place of a patch leaves out is proportional to the patch's solid angle.
    const __m128 solid_angle = _mm_div_ps(_mm_set1_ps(node.flux[3]), r2);
    flattened_ = _mm_add_ps(flattened_, _mm_mul_ps(contribution, solid_angle));
  }

  void add_samples(std::uint32_t begin, std::uint32_t end) {
    // Float sums of a few terms, taken over to double: a sum over all samples must not drown its own tail.
    constexpr std::uint32_t kTerms = 16;
    for (std::uint32_t first = begin; first < end; first += kTerms)
      accumulate(sum_samples(first, std::min(end, first + kTerms)));
  }

  /// given: entered irradiance at the query, or null to interpolate every channel.
  Exitance result(const RgbF* given) const {
    alignas(16) double sum[4];
    _mm_store_pd(sum, low_);
    _mm_store_pd(sum + 2, high_);
    alignas(16) float flux[4];
    _mm_store_ps(flux, near_flux_);
    Exitance out;
    const float unit = octree_.flux_unit;
    const std::array<float, 3> share = surface_share();
    for (std::size_t c = 0; c < 3; ++c) {
      out.irradiance[c] = near_weight_ > 0 ? flux[c] / near_weight_ * unit : 0;
      const float own = given != nullptr ? kernel_.own_irradiance[c] : 0;
      const float e = own > 0 ? own * (*given)[c] + (1 - own) * out.irradiance[c] : out.irradiance[c];
      const float near = kernel_.near[c] * share[c];
      out.exitance[c] = float(sum[c]) * unit + near * e;
      out.error[c] = unit * estimated_error(c, near * (1 - own), out.irradiance[c] / unit);
    }
    return out;
  }

 private:
  __m128 sum_samples(std::uint32_t begin, std::uint32_t end) {
    __m128 sum = _mm_setzero_ps(), squares = _mm_setzero_ps();
    for (std::uint32_t i = begin; i < end; ++i) {
      const TreeSample& s = octree_.samples[i];
      const float dx = s.x - query_.position.x, dy = s.y - query_.position.y, dz = s.z - query_.position.z;
      const float r2 = dx * dx + (dy * dy + dz * dz);
      const __m128 flux = _mm_load_ps(s.flux.data());
      __m128 k = kernel_.table(r2);
      if (r2 < near2_) k = _mm_mul_ps(k, _mm_set1_ps(add_near(i, r2, flux)));
      const __m128 contribution = _mm_mul_ps(k, flux);
      sum = _mm_add_ps(sum, contribution);
      squares = _mm_add_ps(squares, _mm_mul_ps(contribution, contribution));
    }
    const __m128 even = _mm_mul_ps(_mm_mul_ps(sum, sum), _mm_set1_ps(1 / float(end - begin)));
    squares_ = _mm_add_ps(squares_, squares);
    spread_ = _mm_add_ps(spread_, _mm_sub_ps(squares, even));
    return sum;
  }

  // Notes a sample within h for the irradiance around the point and returns the far weight of its kernel.
  // Samples of another sheet are no neighbours on the surface: their kernel stays whole.
  float add_near(std::uint32_t i, float r2, __m128 flux) {
    if (!same_sheet(octree_.normals[i], query_.normal)) return 1;
    const float t2 = r2 / near2_, w = (1 - t2) * (1 - t2);
    near_flux_ = _mm_add_ps(near_flux_, _mm_mul_ps(flux, _mm_set1_ps(w)));
    near_weight_ += w * octree_.samples[i].area;
    const float weight = w / octree_.samples[i].area;
    near_squares_ = _mm_add_ps(near_squares_, _mm_mul_ps(_mm_mul_ps(flux, flux), _mm_set1_ps(weight)));
    return kernel_.split ? far_weight(std::sqrt(t2)) : 1;
  }

  // Standard error of a channel, in flux units. near: the near field's share of the kernel that rests on the
  // interpolated irradiance e.
  float estimated_error(std::size_t c, float near, float e) const {
    alignas(16) float spread[4], squares[4], flattened[4], near_squares[4];
    _mm_store_ps(spread, spread_);
    _mm_store_ps(squares, squares_);
    _mm_store_ps(flattened, flattened_);
    _mm_store_ps(near_squares, near_squares_);
    // A sample stands off its cell's middle by a fraction of the distance over which neighbours differ.
    constexpr float kOffset = 0.2f;
    // Of an irradiance that varies around the point, what its mean misses.
    constexpr float kVariation = 0.2f;
    // A quarter of a power law's curvature; a third of it was measured on surfaces.
    constexpr float kFlattened = 0.3f;
    const float sampling = kOffset * kOffset * std::max(0.0f, spread[c]);
    const float variance = near_weight_ > 0 ? std::max(0.0f, near_squares[c] / near_weight_ - e * e) : 0;
    const float interpolation = kVariation * kVariation * near * near * variance;
    const float noise = noise_ * noise_ * squares[c];
    const float hierarchy = kFlattened * flattened[c];
    return std::sqrt(sampling + interpolation + noise + hierarchy * hierarchy);
  }

  // The part of the near field that is there. Half of a plane's area or less: a border, a corner; more than
  // all of it: a crease, whose excess the near field of steep profiles does not see.
  std::array<float, 3> surface_share() const {
    const float plane = float(std::numbers::pi) * near2_ / 3;  // integral of the weight (1 - r^2/h^2)^2
    const float area = near_weight_ / plane;
    // A few per cent short of a whole plane is the noise of the samples' sum.
    constexpr float kNoise = 1.03f;
    const float place =
        std::clamp((area - 0.5f) * 2 * kNoise, 0.0f, 1.0f) * float(SplitKernel::kBorderRows - 1);
    const std::size_t row = std::min(std::size_t(place), SplitKernel::kBorderRows - 2);
    const float t = place - float(row), corner = std::min(1.0f, 2 * area);
    std::array<float, 3> share;
    for (std::size_t c = 0; c < 3; ++c)
      share[c] = corner * ((1 - t) * kernel_.border[row][c] + t * kernel_.border[row + 1][c]);
    return share;
  }

  void accumulate(__m128 sum) {
    low_ = _mm_add_pd(low_, _mm_cvtps_pd(sum));
    high_ = _mm_add_pd(high_, _mm_cvtps_pd(_mm_movehl_ps(sum, sum)));
  }

  const Octree& octree_;
  const SplitKernel& kernel_;
  const Query& query_;
  float near2_, noise_;
  __m128d low_ = _mm_setzero_pd(), high_ = _mm_setzero_pd();
  __m128 near_flux_ = _mm_setzero_ps(), near_squares_ = _mm_setzero_ps();
  __m128 spread_ = _mm_setzero_ps(), squares_ = _mm_setzero_ps(), flattened_ = _mm_setzero_ps();
  float near_weight_ = 0;
};

}  // namespace opaline
