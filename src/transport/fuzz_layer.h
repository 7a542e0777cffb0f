// SPDX-License-Identifier: GPL-3.0-or-later
// Layer of fibres on a surface: fuzz, dust, velvet.
#pragma once

#include <array>
#include <cstddef>

namespace opaline {

/// Fibres along the normal, white, of optical thickness 1: a homogeneous layer of SGGX microflakes with
/// S = diag(1, 1, s^2). Single scattering is exact; further orders are isotropic, with their exact albedo.
/// from  Heitz et al. 2015, The SGGX microflake distribution; OpenPBR Surface 1.1 for s = roughness^2
class FuzzLayer {
 public:
  /// in    roughness: [0, 1]; below kLeast as kLeast
  explicit FuzzLayer(double roughness);
  static constexpr double kLeast = .25;

  /// Directional albedo; 1 minus it is transmitted. From a table, error below 0.005.
  float reflectance(float cosine) const { return value_of(all_orders_, cosine); }
  /// Hemispherical average of reflectance().
  float average_reflectance() const { return average_; }
  /// BRDF, 1/sr; reciprocal.
  /// in    cosines of both directions to the normal, > 0, and to each other
  float value(float view, float light, float between) const;

 private:
  static constexpr std::size_t kCosines = 65;
  using Table = std::array<float, kCosines>;
  static float value_of(const Table& table, float cosine);

  float flatness_;  // s
  Table all_orders_{}, further_orders_{};
  float average_ = 0, of_further_ = 0;  // 1/(2 pi integral of further_orders_ mu)
};

/// The same layer on each call with a roughness, until the program ends.
const FuzzLayer* shared_fuzz(double roughness);

}  // namespace opaline
