// SPDX-License-Identifier: GPL-3.0-or-later
// A medium as diffusion sees it, with a boundary that gives a half space the share of light that transport gives.
#pragma once

#include <vector>

#include "opaline/transport/medium.h"

namespace opaline {

struct CalibratedMedium {
  CalibratedMedium() = default;
  explicit CalibratedMedium(const HomogeneousMedium& medium);

  /// What leaves per unit area, over the fluence at a depth under the boundary.
  double conductance(double depth) const { return 1 / (2 * mismatch + depth / diffusion); }

  /// What a half space returns of light that entered with this cosine, over what diffusion says.
  double entry_factor(double cos_inside) const;

  double eta = 1;
  double extinction = 0;  ///< sigma_t', per unit of length
  double absorption = 0;  ///< sigma_a
  double albedo = 0;
  double diffusion = 1;  ///< D, lengths
  double mismatch = 1;   ///< A of the boundary condition phi + 2 A D dphi/dn = 0

 private:
  double least_cosine_ = 0;
  std::vector<double> factors_;  // at cosines from least_cosine_ to 1, evenly
};

}  // namespace opaline
