// SPDX-License-Identifier: GPL-3.0-or-later
// Input of a radial profile.
#pragma once

#include <limits>

#include "opaline/enumerations.h"

namespace opaline {

/// One channel of a medium by similarity: isotropic scattering. 1 - alpha' is separate, avoiding
/// cancellation.
struct ReducedMedium {
  double mean_free_path = 0;  ///< 1/sigma_t', >= 0
  double absorbed = 1;        ///< 1 - alpha' = sigma_a/sigma_t', [0, 1]
  double eta = 1;             ///< index of refraction, inside / outside
  /// Thickness of the plate or body, in the unit of mean_free_path, > 0; infinite: a half space. Used by
  /// Multipole only.
  double thickness = std::numeric_limits<double>::infinity();
  NormalizedDiffusionFit fit = NormalizedDiffusionFit::refit;  ///< used by normalized diffusion only
};

/// One layer, from the surface inwards; isotropic scattering, index-matched to its neighbours.
struct FlatLayer {
  double sigma_a = 0, sigma_s_prime = 0;                       ///< 1/length
  double thickness = std::numeric_limits<double>::infinity();  ///< >= 0; infinite in the last layer only
  friend bool operator==(const FlatLayer&, const FlatLayer&) = default;
};

}  // namespace opaline
