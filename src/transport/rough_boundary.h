// SPDX-License-Identifier: GPL-3.0-or-later
// Specular reflection of a rough dielectric boundary: Trowbridge-Reitz (GGX) microfacets with Smith
// shadowing.
#pragma once

#include <array>
#include <vector>

#include "opaline/vec3.h"

namespace opaline {

/// GGX's alpha along the tangent, the direction of largest tilt, and across it.
struct FacetAlphas {
  float along, across;
  friend bool operator==(const FacetAlphas&, const FacetAlphas&) = default;
};

/// in    roughness: [0, 1], alpha is its square; anisotropy: [0, 1], 0: isotropic
/// from  OpenPBR Surface 1.1, specular_roughness_anisotropy
FacetAlphas facet_alphas(float roughness, float anisotropy = 0);

/// The mean of facets within a pixel: the covariances of their slopes are averaged as 2x2 matrices, along the mean
/// tangent.
/// in    alignment: [0, 1], length of the mean of (cos 2a, sin 2a), of the angles a of tangents; slope_variance: of a
///       normal map's slopes along each axis, added twice to alpha^2
/// from  the best GGX for Gaussian slopes is within 5 % of it
FacetAlphas filtered_alphas(const FacetAlphas& facets, float alignment, float slope_variance);

/// Directions are local, unit, x along the tangent, z along the normal, away from the surface. Light
/// reflected into the surface is transmitted, an approximation of multiple reflection at a dielectric.
class RoughBoundary {
 public:
  /// in    roughness: (0, 1], its square is GGX's alpha; eta: inside over outside
  RoughBoundary(double roughness, double eta);
  /// in    tangent_share: cos^2 of the azimuth from the tangent, of the directions for reflectance()
  RoughBoundary(const FacetAlphas& alphas, double eta, float tangent_share);

  /// The larger one.
  float alpha() const { return alphas_.along; }

  /// Directional albedo, over all outgoing directions; from a table, error below 0.002.
  float reflectance(float cosine) const;
  /// The same for facets of reflectance 1: 1 minus the light lost to multiple reflection.
  float reflected_once(float cosine) const;

  /// Light reflected by a facet sampled from the visible ones (Heitz 2018).
  struct Sample {
    Vec3f direction;
    float weight;  ///< reflected radiance over incident radiance, over the density; 0: transmitted
  };
  Sample sample(const Vec3f& view, std::array<double, 2> unit_square) const;

  /// The density of sample(), 1/sr.
  float density(const Vec3f& view, const Vec3f& light) const;
  /// Reflected radiance over incident radiance and solid angle, 1/sr: the BRDF times the cosine.
  float value(const Vec3f& view, const Vec3f& light) const;

 private:
  friend class RoughnessRange;
  friend class AnisotropyRange;
  bool is_isotropic() const { return alphas_.along == alphas_.across; }
  float smith(const Vec3f& direction) const;  ///< visible fraction of facets, G1
  float facets(const Vec3f& normal) const;    ///< density of normals, D

  static constexpr std::size_t kCosines = 33;
  FacetAlphas alphas_;
  float eta_;
  using Table = std::array<float, kCosines>;
  static float value_of(const Table& table, float cosine);
  /// Interpolates the tables.
  void mix(const RoughBoundary& other, float share);
  Table reflectances_{}, once_{};
};

/// Boundaries of one index for all azimuths, interpolated between tabulated ones.
class RoughnessRange {
 public:
  static constexpr float kLeast = .04f;  ///< least roughness of a texture
  /// Roughness range of any roughness.
  explicit RoughnessRange(double eta, float anisotropy = 0)
      : RoughnessRange(eta, anisotropy, kLeast, 1, 17) {}
  /// Range of one roughness.
  RoughnessRange(double eta, float anisotropy, float roughness)
      : RoughnessRange(eta, anisotropy, roughness, roughness, 1) {}

  /// in    roughness: [0, 1], clamped to the range; tangent_share: as RoughBoundary's
  RoughBoundary at(float roughness, float tangent_share = 0) const;

 private:
  RoughnessRange(double eta, float anisotropy, float least, float most, std::size_t steps);

  float anisotropy_, least_, most_;
  std::size_t steps_, sides_;  // steps of roughness, and of azimuth, uniform in the projected alpha
  std::vector<RoughBoundary> boundaries_;  // all azimuths of each roughness
};

/// Boundaries of one index, interpolated between tabulated anisotropies.
class AnisotropyRange {
 public:
  explicit AnisotropyRange(double eta);
  RoughBoundary at(const FacetAlphas& alphas, float tangent_share) const;

 private:
  static constexpr std::array<float, 4> kSteps{0, .5f, .85f, 1};
  std::vector<RoughnessRange> ranges_;
};

}  // namespace opaline
