// SPDX-License-Identifier: GPL-3.0-or-later
// A rough dielectric boundary as mirror: microfacets after Trowbridge & Reitz (GGX), shadowed after Smith.
#pragma once

#include <array>
#include <vector>

#include "opaline/core/vec3.h"

namespace opaline {

/// Directions are local, unit, z along the normal, away from the surface. Light that facets would reflect twice goes
/// below instead, as most of it does at a dielectric.
class RoughBoundary {
 public:
  /// in    roughness: (0, 1], its square is GGX's alpha; eta: inside over outside
  RoughBoundary(double roughness, double eta);

  /// Of GGX: the square of the roughness.
  float alpha() const { return alpha_; }

  /// The share of light from a direction that is reflected, to any side; from a table, error below .002.
  float reflectance(float cosine) const;
  /// The same of facets that reflect all light: 1 without the light that would meet a second one.
  float reflected_once(float cosine) const;

  /// Light that is reflected by a facet drawn with the density of those that the viewer sees (Heitz 2018).
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
  float smith(const Vec3f& direction) const;  ///< share of facets that are seen from there, G1
  float facets(const Vec3f& normal) const;    ///< their distribution, D

  static constexpr std::size_t kCosines = 33;
  float alpha_, eta_;
  using Table = std::array<float, kCosines>;
  static float value_of(const Table& table, float cosine);
  Table reflectances_{}, once_{};
};

/// Boundaries of one index and any roughness, whose tables lie between those of a few.
class RoughnessRange {
 public:
  explicit RoughnessRange(double eta);

  /// in    roughness: [0, 1]; below kLeast it is that
  RoughBoundary at(float roughness) const;

 private:
  static constexpr float kLeast = .04f;
  static constexpr std::size_t kSteps = 16;
  std::vector<RoughBoundary> boundaries_;
};

}  // namespace opaline
