// SPDX-License-Identifier: GPL-3.0-or-later
// A rough dielectric boundary as mirror: microfacets after Trowbridge & Reitz (GGX), shadowed after Smith.
#pragma once

#include <array>
#include <vector>

#include "opaline/vec3.h"

namespace opaline {

/// GGX's alpha along the tangent, where facets are tilted most, and across it.
struct FacetAlphas {
  float along, across;
  friend bool operator==(const FacetAlphas&, const FacetAlphas&) = default;
};

/// in    roughness: [0, 1], alpha is its square; anisotropy: [0, 1], 0: the same all around
/// from  OpenPBR Surface 1.1, specular_roughness_anisotropy
FacetAlphas facet_alphas(float roughness, float anisotropy = 0);

/// Directions are local, unit, x along the tangent, z along the normal, away from the surface. Light that facets would
/// reflect twice goes below instead, as most of it does at a dielectric.
class RoughBoundary {
 public:
  /// in    roughness: (0, 1], its square is GGX's alpha; eta: inside over outside
  RoughBoundary(double roughness, double eta);
  /// in    tangent_share: of the directions that reflectance() tells of, cos^2 of the azimuth from the tangent
  RoughBoundary(const FacetAlphas& alphas, double eta, float tangent_share);

  /// The larger one.
  float alpha() const { return alphas_.along; }

  /// The fraction of light from a direction that is reflected, to any side; from a table, error below .002.
  float reflectance(float cosine) const;
  /// The same of facets that reflect all light: 1 without the light that would meet a second one.
  float reflected_once(float cosine) const;

  /// Light reflected by a facet drawn with the density of those that the viewer sees (Heitz 2018).
  struct Sample {
    Vec3f direction;
    float weight;  ///< reflected radiance over the radiance from there, over the density; 0: it goes below
  };
  Sample sample(const Vec3f& view, std::array<double, 2> unit_square) const;

  /// The density of sample(), 1/sr.
  float density(const Vec3f& view, const Vec3f& light) const;
  /// Reflected radiance over incoming radiance and solid angle, 1/sr: the reflectance function times the cosine.
  float value(const Vec3f& view, const Vec3f& light) const;

 private:
  friend class RoughnessRange;
  bool is_isotropic() const { return alphas_.along == alphas_.across; }
  float smith(const Vec3f& direction) const;  ///< fraction of facets seen from there, G1
  float facets(const Vec3f& normal) const;    ///< their distribution, D

  static constexpr std::size_t kCosines = 33;
  FacetAlphas alphas_;
  float eta_;
  using Table = std::array<float, kCosines>;
  static float value_of(const Table& table, float cosine);
  Table reflectances_{}, once_{};
};

/// Boundaries of one index seen from any side, whose tables lie between those of a few.
class RoughnessRange {
 public:
  /// Roughness range of any roughness.
  explicit RoughnessRange(double eta, float anisotropy = 0)
      : RoughnessRange(eta, anisotropy, kLeast, 1, 17) {}
  /// Range of one roughness.
  RoughnessRange(double eta, float anisotropy, float roughness)
      : RoughnessRange(eta, anisotropy, roughness, roughness, 1) {}

  /// in    roughness: [0, 1], bounded to the range; tangent_share: as RoughBoundary's
  RoughBoundary at(float roughness, float tangent_share = 0) const;

 private:
  static constexpr float kLeast = .04f;
  RoughnessRange(double eta, float anisotropy, float least, float most, std::size_t steps);

  float anisotropy_, least_, most_;
  std::size_t steps_, sides_;  // steps of roughness, and of azimuth, uniform in the projected alpha
  std::vector<RoughBoundary> boundaries_;  // for each roughness those of all sides
};

}  // namespace opaline
