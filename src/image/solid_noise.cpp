// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/solid_noise.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"

namespace opaline {
namespace {

// Gradient noise lies within about +-0.7; a cloud of five octaves within about +-1.
constexpr double kCloudContrast = .75;
constexpr double kVeinWidth = .12;  // noise around 0 at half the contrast
constexpr double kNoiseVariance = .073;
constexpr int kMeanPoints = 1 << 15;
constexpr double kMeanExtent = 64;  // cells

double eased(double t) {
  return t * t * t * (t * (6 * t - 15) + 10);
}

/// Dot product of an offset with the gradient of a lattice point: one of the 12 edges of a cube.
double slope_at(std::uint64_t seed, const std::array<std::int64_t, 3>& cell, const Vec3d& offset) {
  constexpr std::array<std::array<double, 3>, 12> kEdges{{{1, 1, 0},
                                                          {-1, 1, 0},
                                                          {1, -1, 0},
                                                          {-1, -1, 0},
                                                          {1, 0, 1},
                                                          {-1, 0, 1},
                                                          {1, 0, -1},
                                                          {-1, 0, -1},
                                                          {0, 1, 1},
                                                          {0, -1, 1},
                                                          {0, 1, -1},
                                                          {0, -1, -1}}};
  std::uint64_t bits = seed;
  for (const std::int64_t c : cell) bits = hash_bits(bits, std::uint64_t(c));
  const auto& edge = kEdges[(bits >> 32) % kEdges.size()];
  return edge[0] * offset.x + edge[1] * offset.y + edge[2] * offset.z;
}

/// in    p: in cells
double gradient_noise(std::uint64_t seed, const Vec3d& p) {
  const Vec3d base{std::floor(p.x), std::floor(p.y), std::floor(p.z)}, in = p - base;
  const Vec3d ease{eased(in.x), eased(in.y), eased(in.z)};
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> at{corner & 1, corner >> 1 & 1, corner >> 2};
    double weight = 1;
    std::array<std::int64_t, 3> cell;
    Vec3d offset;
    for (std::size_t c = 0; c < 3; ++c) {
      weight *= at[c] ? ease[c] : 1 - ease[c];
      cell[c] = std::int64_t(base[c]) + at[c];
      offset[c] = in[c] - at[c];
    }
    sum += weight * slope_at(seed, cell, offset);
  }
  return sum;
}

/// Fraction of an octave's amplitude left by a filter, whose width is in cells of the octave; a fit.
double left_by_filter(double width) {
  constexpr double kWidest = 2.2;
  return width < kWidest ? std::exp(-width * width / 1.1) : 0;
}

}  // namespace

std::shared_ptr<const SolidNoise> SolidNoise::shared(const NoiseParameters& parameters) {
  static std::mutex mutex;
  static std::vector<std::weak_ptr<const SolidNoise>> all;
  const std::lock_guard lock(mutex);
  std::erase_if(all, [](const auto& noise) { return noise.expired(); });
  for (const auto& known : all)
    if (std::shared_ptr<const SolidNoise> noise = known.lock(); noise && noise->parameters_ == parameters)
      return noise;
  auto noise = std::make_shared<const SolidNoise>(parameters);
  all.push_back(noise);
  return noise;
}

double SolidNoise::blend_at(const Vec3d& point, double width) const {
  // Far outside, cells would be as small as the rounding of coordinates.
  constexpr double kFarthest = 1e12;
  double sum = 0, lost = 0, amplitude = 1, cells = 1 / parameters_.size;
  for (int octave = 0; octave < parameters_.octaves; ++octave, amplitude /= 2, cells *= 2) {
    const double left = left_by_filter(width * cells);
    lost += amplitude * amplitude * (1 - left * left) * kNoiseVariance;
    if (left == 0) continue;
    Vec3d p = point * cells;
    for (std::size_t c = 0; c < 3; ++c)
      p[c] = std::isfinite(p[c]) ? std::clamp(p[c], -kFarthest, kFarthest) : 0;
    sum += amplitude * left * gradient_noise(hash_bits(parameters_.seed, std::uint64_t(octave)), p);
  }
  if (parameters_.pattern == NoisePattern::clouds) return std::clamp(.5 + kCloudContrast * sum, 0., 1.);
  // A Lorentzian over a Gaussian distribution of the lost octaves is about a wider, lower one: the peak of a Voigt
  // profile to 3 %.
  const double widening = std::sqrt(2 * lost / std::numbers::pi) / kVeinWidth;
  const double widened = kVeinWidth * std::pow(1 + std::pow(widening, 1.4), 1 / 1.4), across = sum / widened;
  return kVeinWidth / widened / (1 + across * across);
}

double SolidNoise::filtered_blend(const Vec3d& point, double width) const {
  const double blend = blend_at(point, width), left = left_by_filter(width / parameters_.size);
  return left < 1 ? mean_blend() + std::sqrt(left) * (blend - mean_blend()) : blend;
}

std::array<float, 4> SolidNoise::at(const Vec3d& point, double width) const {
  const double blend = filtered_blend(point, width);
  std::array<float, 4> texel{0, 0, 0, 1};
  for (std::size_t c = 0; c < 3; ++c)
    texel[c] = float(parameters_.low[c] + blend * (parameters_.high[c] - parameters_.low[c]));
  return texel;
}

Vec3d SolidNoise::gradient(const Vec3d& point, double width, std::size_t channel) const {
  if (channel > 2) return {};
  const double step = std::max(width / 2, 1e-3 * parameters_.size / std::exp2(parameters_.octaves - 1));
  Vec3d result;
  for (std::size_t c = 0; c < 3; ++c) {
    Vec3d before = point, behind = point;
    before[c] -= step;
    behind[c] += step;
    result[c] = (filtered_blend(behind, width) - filtered_blend(before, width)) / (behind[c] - before[c]);
  }
  return result * (parameters_.high[channel] - parameters_.low[channel]);
}

std::optional<Texel> SolidNoise::constant() const {
  if (parameters_.low != parameters_.high) return {};
  return Texel{parameters_.low.x, parameters_.low.y, parameters_.low.z, 1};
}

TexelsAboveOne SolidNoise::above_one(const Vec3d& scale) const {
  const double largest =
      std::max(max_component(parameters_.low * scale), max_component(parameters_.high * scale));
  return {largest > 1 ? std::size_t(1) : 0, 1, largest};
}

double SolidNoise::mean_blend() const {
  std::call_once(has_mean_, [&] {
    double sum = 0;
    for (int i = 0; i < kMeanPoints; ++i) {
      const std::array<double, 4> at = r4_point(std::uint64_t(i), {});
      sum += blend_at(Vec3d{at[0], at[1], at[2]} * (kMeanExtent * parameters_.size), 0);
    }
    mean_ = sum / kMeanPoints;
  });
  return mean_;
}

Texel SolidNoise::mean() const {
  const Rgb mean = parameters_.low + (parameters_.high - parameters_.low) * mean_blend();
  return {mean.x, mean.y, mean.z, 1};
}

std::string SolidNoise::path() const {
  return std::string(kNoisePatternNames[std::size_t(parameters_.pattern)]);
}

std::uint64_t SolidNoise::hash() const {
  std::uint64_t bits = hash_bits(std::uint64_t(parameters_.pattern), std::uint64_t(parameters_.octaves));
  bits = hash_bits(bits, parameters_.seed);
  for (const double value : {parameters_.size, parameters_.low.x, parameters_.low.y, parameters_.low.z,
                             parameters_.high.x, parameters_.high.y, parameters_.high.z})
    bits = hash_bits(bits, std::bit_cast<std::uint64_t>(value));
  return bits;
}

}  // namespace opaline
