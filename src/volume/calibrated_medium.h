// SPDX-License-Identifier: GPL-3.0-or-later
// Diffusion medium with a boundary calibrated to the total diffuse reflectance of a half space.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "transport/medium.h"

namespace opaline {

struct CalibratedMedium {
  CalibratedMedium() = default;
  explicit CalibratedMedium(const HomogeneousMedium& medium);
  /// calibrated: a medium of the same eta and about the same albedo
  CalibratedMedium(const HomogeneousMedium& medium, const CalibratedMedium& calibrated);

  /// Exitance over the fluence at a depth under the boundary.
  double conductance(double depth) const { return 1 / (2 * mismatch + depth / diffusion); }

  /// Albedo of a half space for light transmitted at this cosine, over that of diffusion.
  double entry_factor(double cos_inside) const;

  double eta = 1;
  double extinction = 0;  ///< sigma_t', per unit of length
  double absorption = 0;  ///< sigma_a
  double albedo = 0;
  double diffusion = 1;  ///< D, lengths
  double mismatch = 1;   ///< A of the boundary condition phi + 2 A D dphi/dn = 0

  /// Exitance by light scattered more than once, over the emission of the fluence of diffusion along paths to a
  /// flat boundary.
  struct Emission {
    double lit = 1;         ///< with light entering there
    double unlit = 1;       ///< with the fluence growing linearly inwards
    double once_share = 1;  ///< where lit, share of light scattered once in that of both
  };
  Emission emission;

 private:
  double least_cosine_ = 0;
  std::shared_ptr<const std::vector<double>> factors_;  // at cosines from least_cosine_ to 1, evenly
};

/// Media of one eta with sqrt(1 - albedo) uniform over 0 to 1.
std::vector<CalibratedMedium> calibrations_of(double eta);
/// Medium by the calibration of nearest albedo, with the same eta.
CalibratedMedium calibrated(const HomogeneousMedium& medium, std::span<const CalibratedMedium> calibrations);

}  // namespace opaline
