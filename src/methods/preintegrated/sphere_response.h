// SPDX-License-Identifier: GPL-3.0-or-later
// Light leaving a ball under distant light: the diffusion equation in closed form.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "opaline/vec3.h"
#include "volume/calibrated_medium.h"

namespace opaline {

/// Exitance of a ball over transmitted irradiance, by coefficients l = 0, 1, ... of Legendre polynomials in the
/// cosine between normal and light, for first collisions at one depth z:
/// albedo i_l(q (R - z)) / (i_l(q R) + 2 A D q i_l'(q R)); q: decay of diffuse light, 1/length.
/// in    radius, depth: lengths; 0 < depth <= radius
std::vector<double> zonal_response(const CalibratedMedium& medium, double radius, double depth,
                                   std::size_t count);
/// The same for first collisions after exponentially distributed free paths along the radius, up to the centre.
std::vector<double> zonal_response(const CalibratedMedium& medium, double radius, std::size_t count);

/// Coefficients of transmitted irradiance, max(0, cosine) x Ft, for unit irradiance across the direction. Each
/// direction is weighted to give the exact exitance of a half space.
std::vector<double> transmitted_zonal(const CalibratedMedium& medium, std::size_t count);

/// Contrast of exitance over that of irradiance, on a flat body, at a wave number, 1/length.
double kept_contrast(const CalibratedMedium& medium, double wave_number);

/// Wave number with half of the contrast, 1/length.
double half_contrast(const CalibratedMedium& medium);

/// Exitance of a ball over the irradiance across a parallel beam, in R G B. Flat: the exact half space.
class SphereResponse {
 public:
  explicit SphereResponse(const std::array<CalibratedMedium, 3>& media);

  /// in    cosine: of the beam to the normal; curvature: 1/radius, 1/length; flat if not above 0
  RgbF at(float cosine, float curvature) const;

 private:
  static constexpr std::size_t kCosines = 97, kCurvatures = 41;

  float length_ = 1;  // radius at the table's middle row
  std::vector<std::array<RgbF, kCosines>> table_;
};

}  // namespace opaline
