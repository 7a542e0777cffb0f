// SPDX-License-Identifier: GPL-3.0-or-later
// Exact albedo of an isotropically scattering half space behind a smooth boundary.
#pragma once

#include <vector>

namespace opaline {

/// Albedo of a half space: diffuse reflection of transmitted light.
class HalfSpace {
 public:
  /// in    absorbed = 1 - albedo in [0, 1]; eta, inside over outside, > 0
  /// from  Chandrasekhar 1960, Radiative Transfer, sec. 38 (the H function and diffuse reflection), with
  ///       Fresnel's reflection inside by a linear system over its quadrature points; derived in
  ///       src/diffusion/README.md
  HalfSpace(double absorbed, double eta);

  /// Total diffuse reflectance per transmitted flux, of diffuse light.
  /// out   [0, 1]; relative error below 1e-9 for eta from 0.1 to 10; exactly 1 if absorbed is 0
  double diffuse_share() const { return diffuse_share_; }
  /// The same for light from one direction.
  /// in    cos_inside: with the inward normal, behind the boundary, [0, 1]
  double share(double cos_inside) const;

 private:
  double absorbed_;
  double diffuse_share_ = 0;
  struct Source {
    double cosine, strength;  // light reflected by the boundary or transmitted, through the H function
  };
  std::vector<Source> sources_;
};

/// HalfSpace::diffuse_share.
double half_space_albedo(double absorbed, double eta);

}  // namespace opaline
