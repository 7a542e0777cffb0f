// SPDX-License-Identifier: GPL-3.0-or-later
// The sum over far nodes and samples at one query point, and its near field.
#pragma once

#include <emmintrin.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "exitance/evaluate.h"
#include "exitance/point_sums.h"
#include "sampling/sample_surface.h"

namespace opaline {

class Gather {
 public:
  Gather(const EvaluateInput& input, const Query& query)
      : input_(input),
        octree_(input.octree),
        kernel_(input.kernel),
        query_(query),
        near2_(input.kernel.radius * input.kernel.radius) {}

  /// A node beyond the near field, lanes of r2 the squared distances of its centroids.
  void add_node(const OctreeNode& node, __m128 r2) {
    alignas(16) float d[4];
    _mm_store_ps(d, r2);
    // Lights of one colour give all channels the same centroid.
    const __m128 k = d[0] == d[1] && d[1] == d[2] ? kernel_.table(d[0]) : kernel_.table(d[0], d[1], d[2]);
    const __m128 contribution = _mm_mul_ps(k, _mm_load_ps(node.flux.data()));
    accumulate(contribution);
    // The error of a point for a patch is proportional to the patch's solid angle.
    const __m128 solid_angle = _mm_div_ps(_mm_set1_ps(node.flux[3]), r2);
    flattened_ = _mm_add_ps(flattened_, _mm_mul_ps(contribution, solid_angle));
  }

  void add_samples(std::uint32_t begin, std::uint32_t end) {
    // Partial sums in float, totals in double: a sum over all samples would lose its tail in float.
    constexpr std::uint32_t kTerms = 16;
    for (std::uint32_t first = begin; first < end; first += kTerms)
      accumulate(sum_samples(first, std::min(end, first + kTerms)));
  }

  /// given: transmitted irradiance at the query, or null to interpolate every channel.
  Exitance result(const RgbF* given) const {
    alignas(16) double sum[4];
    _mm_store_pd(sum, low_);
    _mm_store_pd(sum + 2, high_);
    alignas(16) float spread[4], squares[4], sheets[4], flattened[4], near_flux[4], near_squares[4];
    _mm_store_ps(spread, spread_);
    _mm_store_ps(squares, squares_);
    _mm_store_ps(sheets, sheets_);
    _mm_store_ps(flattened, flattened_);
    _mm_store_ps(near_flux, near_flux_);
    _mm_store_ps(near_squares, near_squares_);
    // Error of a point for a patch over the patch's solid angle: 3/8 for a power law 1/r^3 above a plane,
    // less on surfaces, where errors of nodes on opposite sides partly cancel.
    constexpr float kFlattened = 0.12f;
    PointSums<float> sums;
    sums.near_area = near_weight_;
    for (std::size_t c = 0; c < 3; ++c) {
      sums.far[c] = float(sum[c]);
      sums.spread[c] = spread[c];
      sums.squares[c] = squares[c];
      sums.sheets[c] = sheets[c];
      sums.hierarchy[c] = kFlattened * input_.cloud.flattened[c] * flattened[c];
      sums.near_flux[c] = near_flux[c];
      sums.near_squares[c] = near_squares[c];
    }
    std::array<float, 3> own{};
    for (std::size_t c = 0; given != nullptr && c < 3; ++c) own[c] = (*given)[c];
    const PointResult<float> r = result_from(sums, input_, given != nullptr ? &own : nullptr);
    const auto rgb = [](const std::array<float, 3>& v) { return RgbF{v[0], v[1], v[2]}; };
    return {rgb(r.exitance), rgb(r.irradiance), rgb(r.near), rgb(r.error)};
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
      if (r2 < near2_ && !same_sheet(octree_.normals[i], query_.normal)) {
        const float moved2 = moved_distance2({dx, dy, dz}, octree_.normals[i], near2_);
        const __m128 change = _mm_mul_ps(_mm_sub_ps(k, kernel_.table(moved2)), flux);
        sheets_ = _mm_add_ps(sheets_, _mm_mul_ps(change, change));
      }
      sum = _mm_add_ps(sum, contribution);
      squares = _mm_add_ps(squares, _mm_mul_ps(contribution, contribution));
    }
    const __m128 even = _mm_mul_ps(_mm_mul_ps(sum, sum), _mm_set1_ps(1 / float(end - begin)));
    squares_ = _mm_add_ps(squares_, squares);
    spread_ = _mm_add_ps(spread_, _mm_sub_ps(squares, even));
    return sum;
  }

  // Adds a sample within h to the irradiance around the point, and returns the far weight of its kernel, the
  // whole kernel on another sheet.
  float add_near(std::uint32_t i, float r2, __m128 flux) {
    if (!same_sheet(octree_.normals[i], query_.normal)) return 1;
    const float t2 = r2 / near2_, w = (1 - t2) * (1 - t2);
    near_flux_ = _mm_add_ps(near_flux_, _mm_mul_ps(flux, _mm_set1_ps(w)));
    near_weight_ += w * octree_.samples[i].area;
    const float weight = w / octree_.samples[i].area;
    near_squares_ = _mm_add_ps(near_squares_, _mm_mul_ps(_mm_mul_ps(flux, flux), _mm_set1_ps(weight)));
    return kernel_.split ? far_weight(std::sqrt(t2)) : 1;
  }

  void accumulate(__m128 sum) {
    low_ = _mm_add_pd(low_, _mm_cvtps_pd(sum));
    high_ = _mm_add_pd(high_, _mm_cvtps_pd(_mm_movehl_ps(sum, sum)));
  }

  const EvaluateInput& input_;
  const Octree& octree_;
  const SplitKernel& kernel_;
  const Query& query_;
  float near2_;
  __m128d low_ = _mm_setzero_pd(), high_ = _mm_setzero_pd();
  __m128 near_flux_ = _mm_setzero_ps(), near_squares_ = _mm_setzero_ps();
  __m128 sheets_ = _mm_setzero_ps();
  __m128 spread_ = _mm_setzero_ps(), squares_ = _mm_setzero_ps(), flattened_ = _mm_setzero_ps();
  float near_weight_ = 0;
};

}  // namespace opaline
