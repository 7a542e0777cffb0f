// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/transport/rough_boundary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "opaline/core/random.h"
#include "opaline/transport/fresnel.h"

namespace opaline {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace

RoughBoundary::RoughBoundary(double roughness, double eta)
    : alpha_(float(roughness * roughness)), eta_(float(eta)) {
  constexpr std::uint64_t kSamples = 1024;
  for (std::size_t i = 0; i < kCosines; ++i) {
    const float cosine = std::max(1e-3f, float(i) / float(kCosines - 1));
    const Vec3f view{std::sqrt(1 - cosine * cosine), 0, cosine};
    double sum = 0, once = 0;
    for (std::uint64_t s = 0; s < kSamples; ++s) {
      const auto [light, weight] = sample(view, r2_point(s, {.5, .5}));
      if (!(weight > 0)) continue;
      sum += double(weight);
      once += double(weight / fresnel_reflectance(std::min(dot(view, normalized(view + light)), 1.0f), eta_));
    }
    reflectances_[i] = float(sum / double(kSamples));
    once_[i] = float(once / double(kSamples));
  }
}

float RoughBoundary::reflectance(float cosine) const {
  return value_of(reflectances_, cosine);
}

float RoughBoundary::reflected_once(float cosine) const {
  return value_of(once_, cosine);
}

float RoughBoundary::value_of(const Table& table, float cosine) {
  const float place = std::clamp(cosine, 0.0f, 1.0f) * float(kCosines - 1);
  const std::size_t i = std::min(std::size_t(place), kCosines - 2);
  const float share = place - float(i);
  return table[i] * (1 - share) + table[i + 1] * share;
}

float RoughBoundary::smith(const Vec3f& direction) const {
  const float tangent2 =
      (direction.x * direction.x + direction.y * direction.y) / (direction.z * direction.z);
  return 2 / (1 + std::sqrt(1 + alpha_ * alpha_ * tangent2));
}

float RoughBoundary::facets(const Vec3f& normal) const {
  const float a2 = alpha_ * alpha_;
  const float slope2 = (normal.x * normal.x + normal.y * normal.y) / a2 + normal.z * normal.z;
  return 1 / (kPi * a2 * slope2 * slope2);
}

// Facets of a rough surface are those of a hemisphere, stretched: its disc as seen by the viewer is drawn from evenly.
RoughBoundary::Sample RoughBoundary::sample(const Vec3f& view, std::array<double, 2> unit_square) const {
  const Vec3f stretched = normalized(Vec3f{alpha_ * view.x, alpha_ * view.y, view.z});
  Vec3f x, y;
  tangent_frame(stretched, x, y);
  const float radius = float(std::sqrt(unit_square[0])), phi = 2 * kPi * float(unit_square[1]);
  // y of the frame that has x level: half of the disc is seen foreshortened.
  const float level = std::sqrt(stretched.x * stretched.x + stretched.y * stretched.y);
  if (level > 1e-6f) {
    x = Vec3f{-stretched.y, stretched.x, 0} * (1 / level);
    y = cross(stretched, x);
  }
  const float a = radius * std::cos(phi), share = .5f * (1 + stretched.z);
  const float b = (1 - share) * std::sqrt(std::max(0.0f, 1 - a * a)) + share * radius * std::sin(phi);
  const Vec3f facet = x * a + y * b + stretched * std::sqrt(std::max(0.0f, 1 - a * a - b * b));
  const Vec3f normal = normalized(Vec3f{alpha_ * facet.x, alpha_ * facet.y, std::max(1e-6f, facet.z)});
  const float cosine = dot(view, normal);
  const Vec3f light = normal * (2 * cosine) - view;
  if (!(light.z > 0 && cosine > 0)) return {light, 0};
  const float seen = smith(view), lit = smith(light);
  // G2 / G1 with heights in common.
  const float both = lit / (seen + lit - seen * lit);
  return {light, fresnel_reflectance(std::min(cosine, 1.0f), eta_) * both};
}

float RoughBoundary::density(const Vec3f& view, const Vec3f& light) const {
  if (!(view.z > 0 && light.z > 0)) return 0;
  return smith(view) * facets(normalized(view + light)) / (4 * view.z);
}

float RoughBoundary::value(const Vec3f& view, const Vec3f& light) const {
  if (!(view.z > 0 && light.z > 0)) return 0;
  const Vec3f normal = normalized(view + light);
  const float seen = smith(view), lit = smith(light);
  const float both = seen * lit / (seen + lit - seen * lit);
  return fresnel_reflectance(std::min(dot(view, normal), 1.0f), eta_) * both * facets(normal) / (4 * view.z);
}

RoughnessRange::RoughnessRange(double eta) {
  for (std::size_t i = 0; i <= kSteps; ++i)
    boundaries_.emplace_back(double(kLeast) + (1 - double(kLeast)) * double(i) / double(kSteps), eta);
}

RoughBoundary RoughnessRange::at(float roughness) const {
  const float bounded = std::clamp(roughness, kLeast, 1.0f);
  const float place = (bounded - kLeast) / (1 - kLeast) * float(kSteps);
  const std::size_t i = std::min(std::size_t(place), kSteps - 1);
  const float share = place - float(i);
  RoughBoundary boundary = boundaries_[i];
  boundary.alpha_ = bounded * bounded;
  const auto mix = [&](RoughBoundary::Table& table, const RoughBoundary::Table& next) {
    for (std::size_t c = 0; c < table.size(); ++c) table[c] = table[c] * (1 - share) + next[c] * share;
  };
  mix(boundary.reflectances_, boundaries_[i + 1].reflectances_);
  mix(boundary.once_, boundaries_[i + 1].once_);
  return boundary;
}

}  // namespace opaline
