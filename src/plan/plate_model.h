// SPDX-License-Identifier: GPL-3.0-or-later
// Model error in thin plates, where it is largest and quick to compute.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "bodies/plan.h"
#include "diffusion/slab_walks.h"

namespace opaline {

struct PlateChannel {
  double optical_thickness = 0;  ///< in mean free paths
  SlabLight profile, walks;
};

/// A flat body and its reflectance and transmittance of diffuse light.
struct PlateModel {
  std::string body;
  ProfileKind kind = ProfileKind::dipole;
  double thickness = 0;                                 ///< BodyPlan::thickness
  std::array<std::optional<PlateChannel>, 3> channels;  ///< none: no scattering, or the plate is thick
};

/// Bodies thinner than ten mean free paths in some channel and many times wider than thick; about 0.02 s of
/// CPU each, 1 s at an index of refraction of 10.
std::vector<PlateModel> compare_plates(const Scene& scene, const Plan& plan);

}  // namespace opaline
