// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/rough_boundary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
// Bound of the density for facets level in one direction.
constexpr float kLeastAcross = 1e-3f;
// Alpha of the least roughness, 0.001: below, single precision does not resolve the spread of directions.
constexpr float kLeastAlpha = 1e-6f;
constexpr std::size_t kSides = 9;

/// Alpha along the azimuth of a view, by its tangent_share.
float seen_alpha(const FacetAlphas& alphas, float tangent_share) {
  const float along2 = alphas.along * alphas.along, across2 = alphas.across * alphas.across;
  return std::sqrt(across2 + (along2 - across2) * tangent_share);
}

/// tangent_share of a view with its alpha at this fraction between the smaller and the larger one.
float share_of_side(const FacetAlphas& alphas, float part) {
  const float seen = alphas.across + (alphas.along - alphas.across) * part;
  const float along2 = alphas.along * alphas.along, across2 = alphas.across * alphas.across;
  return along2 > across2 ? std::clamp((seen * seen - across2) / (along2 - across2), 0.0f, 1.0f) : 0;
}

}  // namespace

FacetAlphas facet_alphas(float roughness, float anisotropy) {
  const float alpha = std::max(roughness * roughness, kLeastAlpha);
  if (!(anisotropy > 0)) return {alpha, alpha};
  const float ratio = 1 - anisotropy, along = alpha * std::sqrt(2 / (1 + ratio * ratio));
  return {along, std::max(ratio * along, std::min(kLeastAcross, along))};
}

FacetAlphas filtered_alphas(const FacetAlphas& facets, float alignment, float slope_variance) {
  const float along2 = facets.along * facets.along, across2 = facets.across * facets.across,
              mean = (along2 + across2) / 2 + 2 * slope_variance,
              difference = (along2 - across2) / 2 * alignment;
  return {std::sqrt(std::min(1.f, mean + difference)), std::sqrt(std::min(1.f, mean - difference))};
}

RoughBoundary::RoughBoundary(double roughness, double eta)
    : RoughBoundary({std::max(float(roughness * roughness), kLeastAlpha),
                     std::max(float(roughness * roughness), kLeastAlpha)},
                    eta, 0) {}

RoughBoundary::RoughBoundary(const FacetAlphas& alphas, double eta, float tangent_share)
    : alphas_(alphas), eta_(float(eta)) {
  const float along = std::sqrt(tangent_share), across = std::sqrt(1 - tangent_share);
  constexpr std::uint64_t kSamples = 1024;
  for (std::size_t i = 0; i < kCosines; ++i) {
    const float cosine = std::max(1e-3f, float(i) / float(kCosines - 1));
    const float sine = std::sqrt(1 - cosine * cosine);
    const Vec3f view = is_isotropic() ? Vec3f{sine, 0, cosine} : Vec3f{sine * along, sine * across, cosine};
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
  const float x2 = direction.x * direction.x, y2 = direction.y * direction.y, z2 = direction.z * direction.z;
  const float a = alphas_.along, b = alphas_.across;
  const float stretched2 = is_isotropic() ? a * a * ((x2 + y2) / z2) : (a * a * x2 + b * b * y2) / z2;
  return 2 / (1 + std::sqrt(1 + stretched2));
}

float RoughBoundary::facets(const Vec3f& normal) const {
  const float x2 = normal.x * normal.x, y2 = normal.y * normal.y, z2 = normal.z * normal.z;
  const float a = alphas_.along, b = alphas_.across;
  const float slope2 = (is_isotropic() ? (x2 + y2) / (a * a) : x2 / (a * a) + y2 / (b * b)) + z2;
  return 1 / (kPi * (a * b) * slope2 * slope2);
}

// Facets of a rough surface are those of a stretched hemisphere: samples its projected disc uniformly.
RoughBoundary::Sample RoughBoundary::sample(const Vec3f& view, std::array<double, 2> unit_square) const {
  const Vec3f stretched = normalized(Vec3f{alphas_.along * view.x, alphas_.across * view.y, view.z});
  Vec3f x, y;
  tangent_frame(stretched, x, y);
  const float radius = float(std::sqrt(unit_square[0])), phi = 2 * kPi * float(unit_square[1]);
  // y of the frame with horizontal x: half of the disc is foreshortened.
  const float level = std::sqrt(stretched.x * stretched.x + stretched.y * stretched.y);
  if (level > 1e-6f) {
    x = Vec3f{-stretched.y, stretched.x, 0} * (1 / level);
    y = cross(stretched, x);
  }
  const float a = radius * std::cos(phi), share = .5f * (1 + stretched.z);
  const float b = (1 - share) * std::sqrt(std::max(0.0f, 1 - a * a)) + share * radius * std::sin(phi);
  const Vec3f facet = x * a + y * b + stretched * std::sqrt(std::max(0.0f, 1 - a * a - b * b));
  const Vec3f normal =
      normalized(Vec3f{alphas_.along * facet.x, alphas_.across * facet.y, std::max(1e-6f, facet.z)});
  const float cosine = dot(view, normal);
  const Vec3f light = normal * (2 * cosine) - view;
  if (!(light.z > 0 && cosine > 0)) return {light, 0};
  const float seen = smith(view), lit = smith(light);
  // G2 / G1, height-correlated.
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

void RoughBoundary::mix(const RoughBoundary& other, float share) {
  for (std::size_t c = 0; c < kCosines; ++c) {
    reflectances_[c] = reflectances_[c] * (1 - share) + other.reflectances_[c] * share;
    once_[c] = once_[c] * (1 - share) + other.once_[c] * share;
  }
}

RoughnessRange::RoughnessRange(double eta, float anisotropy, float least, float most, std::size_t steps)
    : anisotropy_(anisotropy),
      least_(least),
      most_(most),
      steps_(steps),
      sides_(anisotropy > 0 ? kSides : 1) {
  for (std::size_t i = 0; i < steps_; ++i) {
    double roughness = double(least_);
    if (steps_ > 1) roughness += (double(most_) - double(least_)) * double(i) / double(steps_ - 1);
    if (sides_ == 1) {
      boundaries_.emplace_back(roughness, eta);
      continue;
    }
    const FacetAlphas alphas = facet_alphas(float(roughness), anisotropy_);
    for (std::size_t k = 0; k < sides_; ++k)
      boundaries_.emplace_back(alphas, eta, share_of_side(alphas, float(k) / float(sides_ - 1)));
  }
}

RoughBoundary RoughnessRange::at(float roughness, float tangent_share) const {
  const float bounded = std::clamp(roughness, least_, most_);
  const float place = steps_ > 1 ? (bounded - least_) / (most_ - least_) * float(steps_ - 1) : 0;
  const std::size_t i = steps_ > 1 ? std::min(std::size_t(place), steps_ - 2) : 0;
  const FacetAlphas alphas = facet_alphas(bounded, anisotropy_);
  const auto of_step = [&](std::size_t step) {
    if (sides_ == 1) return boundaries_[step];
    const float spread = std::max(alphas.along - alphas.across, 1e-6f);
    const float side = (seen_alpha(alphas, tangent_share) - alphas.across) / spread * float(sides_ - 1);
    const std::size_t k = std::min(std::size_t(std::max(side, 0.0f)), sides_ - 2);
    RoughBoundary boundary = boundaries_[step * sides_ + k];
    boundary.mix(boundaries_[step * sides_ + k + 1], side - float(k));
    return boundary;
  };
  RoughBoundary boundary = of_step(i);
  boundary.alphas_ = alphas;
  if (steps_ > 1) boundary.mix(of_step(i + 1), place - float(i));
  return boundary;
}

AnisotropyRange::AnisotropyRange(double eta) {
  for (const float anisotropy : kSteps) ranges_.emplace_back(eta, anisotropy);
}

RoughBoundary AnisotropyRange::at(const FacetAlphas& alphas, float tangent_share) const {
  const float mean2 = (alphas.along * alphas.along + alphas.across * alphas.across) / 2,
              roughness = std::sqrt(std::sqrt(mean2)), anisotropy = 1 - alphas.across / alphas.along;
  std::size_t step = 0;
  while (step + 2 < kSteps.size() && anisotropy >= kSteps[step + 1]) ++step;
  RoughBoundary boundary = ranges_[step].at(roughness, tangent_share);
  boundary.mix(ranges_[step + 1].at(roughness, tangent_share),
               (anisotropy - kSteps[step]) / (kSteps[step + 1] - kSteps[step]));
  boundary.alphas_ = alphas;
  return boundary;
}

}  // namespace opaline
