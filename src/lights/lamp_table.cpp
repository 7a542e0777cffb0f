// SPDX-License-Identifier: GPL-3.0-or-later
#include "lights/lamp_table.h"

#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lights/light_kind.h"

namespace opaline {
namespace {

// Added to cosines, at the surface and off a spot's axis, as a bound of rounding, so visible lights keep a
// nonzero probability.
constexpr float kTrace = 1e-5f;
constexpr float kLeastSquare = 1e-30f;

}  // namespace

LampTable::LampTable(std::span<const Light> lights, std::span<const std::uint32_t> order,
                     std::span<const RgbF> colours) {
  Rgb total;
  for (const Light& light : lights) total += emission(light);
  for (const std::uint32_t l : order) {
    const Light& light = lights[l];
    const Lamp lamp = lamp_of(light).value();
    const Rgb colour = emission(light);
    x_.push_back(float(lamp.center.x));
    y_.push_back(float(lamp.center.y));
    z_.push_back(float(lamp.center.z));
    double intensity = 0;
    for (std::size_t c = 0; c < 3; ++c)
      if (total[c] > 0) intensity += colour[c] / total[c];
    intensity_.push_back(float(intensity * lamp.intensity));
    for (std::size_t c = 0; c < 3; ++c)
      colours_[c].push_back(intensity > 0 ? float(double(colours[l][c]) / intensity) : 0);
    has_spots_ |= lamp.facing.has_value();
    const Vec3f way(lamp.facing.value_or(Vec3d{}));
    const double rim = lamp.facing ? std::cos(lamp.reach) - double(kTrace) : -3,
                 full = lamp.facing ? std::cos(lamp.full) : -2;
    way_x_.push_back(way.x);
    way_y_.push_back(way.y);
    way_z_.push_back(way.z);
    rim_.push_back(float(rim));
    per_fade_.push_back(float(1 / std::max(full - rim, double(kTrace))));
  }
  for (std::vector<float>* column :
       {&x_, &y_, &z_, &intensity_, &way_x_, &way_y_, &way_z_, &rim_, &per_fade_})
    column->resize(weights());
  for (std::vector<float>& channel : colours_) channel.resize(weights());
}

// Four lights at once.
template <bool has_spots>
void LampTable::weigh_block(const Vec3f& point, const Vec3f& normal, std::size_t first,
                            float* weights) const {
  const __m128 zero = _mm_setzero_ps(), one = _mm_set1_ps(1), least = _mm_set1_ps(kLeastSquare);
  const auto along = [](const Vec3f& d, __m128 x, __m128 y, __m128 z) {
    return _mm_add_ps(_mm_add_ps(_mm_mul_ps(_mm_set1_ps(d.x), x), _mm_mul_ps(_mm_set1_ps(d.y), y)),
                      _mm_mul_ps(_mm_set1_ps(d.z), z));
  };
  for (std::size_t i = first; i < first + kBlock; i += 4) {
    const __m128 x = _mm_sub_ps(_mm_loadu_ps(&x_[i]), _mm_set1_ps(point.x)),
                 y = _mm_sub_ps(_mm_loadu_ps(&y_[i]), _mm_set1_ps(point.y)),
                 z = _mm_sub_ps(_mm_loadu_ps(&z_[i]), _mm_set1_ps(point.z));
    const __m128 square = _mm_add_ps(_mm_add_ps(_mm_mul_ps(x, x), _mm_mul_ps(y, y)), _mm_mul_ps(z, z));
    const __m128 per_d = _mm_div_ps(one, _mm_sqrt_ps(_mm_max_ps(square, least)));
    const __m128 above = _mm_add_ps(_mm_mul_ps(along(normal, x, y, z), per_d), _mm_set1_ps(kTrace));
    __m128 weight = _mm_mul_ps(_mm_mul_ps(_mm_loadu_ps(&intensity_[i]), _mm_max_ps(above, zero)),
                               _mm_mul_ps(per_d, per_d));
    if constexpr (has_spots) {
      const __m128 off = _mm_mul_ps(per_d, _mm_add_ps(_mm_add_ps(_mm_mul_ps(_mm_loadu_ps(&way_x_[i]), x),
                                                                 _mm_mul_ps(_mm_loadu_ps(&way_y_[i]), y)),
                                                      _mm_mul_ps(_mm_loadu_ps(&way_z_[i]), z)));
      const __m128 fading =
          _mm_mul_ps(_mm_sub_ps(_mm_sub_ps(zero, off), _mm_loadu_ps(&rim_[i])), _mm_loadu_ps(&per_fade_[i]));
      const __m128 share = _mm_min_ps(_mm_max_ps(fading, zero), one);
      weight = _mm_mul_ps(weight, _mm_mul_ps(share, share));
    }
    _mm_storeu_ps(weights + (i - first), weight);
  }
}

void LampTable::weigh(const Vec3f& point, const Vec3f& normal, std::span<float> weights) const {
  for (std::size_t first = 0; first < x_.size(); first += kBlock)
    if (has_spots_)
      weigh_block<true>(point, normal, first, &weights[first]);
    else
      weigh_block<false>(point, normal, first, &weights[first]);
}

RgbF LampTable::brought_by_block(std::size_t block, std::span<const float> weights) const {
  RgbF brought;
  for (std::size_t c = 0; c < 3; ++c) {
    __m128 sums = _mm_setzero_ps();
    for (std::size_t i = block * kBlock; i < (block + 1) * kBlock; i += 4)
      sums = _mm_add_ps(sums, _mm_mul_ps(_mm_loadu_ps(&colours_[c][i]), _mm_loadu_ps(&weights[i])));
    alignas(16) std::array<float, 4> lanes;
    _mm_store_ps(lanes.data(), sums);
    brought[c] = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
  }
  return brought;
}

WeighedDraw::WeighedDraw(const LampTable& lamps, std::span<const float> weights, double draws)
    : lamps_(lamps), weights_(weights), blocks_(weights.size() / kBlock) {
  double sum = 0;
  for (std::size_t b = 0; b < blocks_; ++b) {
    constexpr std::size_t kLanes = 4;
    std::array<float, kLanes> sums{}, largest{};
    for (std::size_t i = 0; i < kBlock; i += kLanes)
      for (std::size_t k = 0; k < kLanes; ++k) {
        const float weight = weights[b * kBlock + i + k];
        sums[k] += weight;
        largest[k] = largest[k] > weight ? largest[k] : weight;
      }
    sums_[b] = double((sums[0] + sums[1]) + (sums[2] + sums[3]));
    largest_[b] = std::max(std::max(largest[0], largest[1]), std::max(largest[2], largest[3]));
    sum += sums_[b];
  }
  if (!(sum > 0)) return;
  // Limiting certain lights to 1 raises the other weights, so more lights become certain.
  scale_ = draws / sum;
  for (std::size_t sure = 0;;) {
    std::size_t now = 0;
    double rest = 0;
    for (std::size_t b = 0; b < blocks_; ++b) {
      if (!is_sure(largest_[b])) {
        rest += sums_[b];
        continue;
      }
      for (std::size_t i = b * kBlock; i < (b + 1) * kBlock; ++i)
        if (is_sure(weights[i]))
          ++now;
        else
          rest += double(weights[i]);
    }
    if (now == sure) return;
    sure = now;
    const double left = draws - double(sure);
    scale_ = left > 0 && rest > 0 ? left / rest : left > 0 ? std::numeric_limits<double>::max() : scale_;
    if (!(left > 0) || !(rest > 0)) return;
  }
}

double WeighedDraw::length_of_others(std::size_t block) const {
  if (!is_sure(largest_[block])) return sums_[block] * scale_;
  double length = 0;
  for (std::size_t i = block * kBlock; i < (block + 1) * kBlock; ++i)
    if (!is_sure(weights_[i])) length += expected(i);
  return length;
}

std::size_t WeighedDraw::take_sure(std::span<Stratum> strata) const {
  std::size_t taken = 0;
  for (std::size_t b = 0; b < blocks_; ++b) {
    if (!(largest_[b] > 0) || !is_sure(largest_[b])) continue;
    for (std::size_t i = b * kBlock; i < (b + 1) * kBlock && taken < strata.size(); ++i)
      if (weights_[i] > 0 && is_sure(weights_[i]))
        strata[taken++] = {0, i, 1, lamps_.brought(i, weights_[i])};
  }
  return taken;
}

/// Places lights side by side; lengths in strata.
class WeighedDraw::OtherLamps {
 public:
  explicit OtherLamps(std::span<Stratum> strata) : strata_(strata) { begin_stratum(0); }

  /// Adds a length to the current stratum; true if its sample is not in it.
  bool passes(double length) const {
    const double end = end_ + length;
    return end < border_ && (place_ < end_ || place_ >= end);
  }
  void pass(double length, const RgbF& brought) {
    strata_[stratum_].brought += brought;
    end_ += length;
  }
  void add(std::size_t lamp, double length, const RgbF& brought) {
    if (passes(length)) return pass(length, brought);
    const double end = end_ + length;
    for (;;) {
      const double border = std::min(end, border_);
      Stratum& own = strata_[stratum_];
      if (place_ >= end_ && place_ < border) {
        own.lamp = lamp;
        own.expected = float(length);
      }
      own.brought += brought * float((border - end_) / length);
      end_ = border;
      if (end <= border_ || stratum_ + 1 == strata_.size()) return;
      begin_stratum(stratum_ + 1);
    }
  }

 private:
  void begin_stratum(std::size_t stratum) {
    stratum_ = stratum;
    border_ = double(stratum + 1);
    place_ = double(stratum) + strata_[stratum].place;
  }

  std::span<Stratum> strata_;
  std::size_t stratum_ = 0;  // current
  double border_, place_;    // its end, and its sampled position
  double end_ = 0;           // end of the lights so far
};

void WeighedDraw::take_others(std::span<Stratum> strata) const {
  double length = 0;
  for (std::size_t b = 0; b < blocks_; ++b) length += length_of_others(b);
  if (strata.empty() || !(length > 0)) return;
  const double per_step = double(strata.size()) / length;
  OtherLamps others(strata);
  for (std::size_t b = 0; b < blocks_; ++b) {
    const double of_block = length_of_others(b) * per_step;
    if (!is_sure(largest_[b]) && others.passes(of_block)) {
      others.pass(of_block, lamps_.brought_by_block(b, weights_));
      continue;
    }
    for (std::size_t i = b * kBlock; i < (b + 1) * kBlock; ++i)
      if (weights_[i] > 0 && !is_sure(weights_[i]))
        others.add(i, expected(i) * per_step, lamps_.brought(i, weights_[i]));
  }
}

}  // namespace opaline
