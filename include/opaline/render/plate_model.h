// SPDX-License-Identifier: GPL-3.0-or-later
// The model's own error where it is largest and can be told at once: in thin plates.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "opaline/diffusion/slab_walks.h"
#include "opaline/render/plan.h"

namespace opaline {

/// A flat body and what it does with diffuse light, channel by channel.
struct PlateModel {
  std::string body;
  double thickness = 0;  ///< mm, the mean
  Rgb optical_thickness{};
  std::array<SlabLight, 3> profile, walks;
};

/// Bodies thinner than ten mean free paths in some channel and many times wider than thick; about .1 s of CPU each.
std::vector<PlateModel> compare_plates(const Scene& scene, const World& world, const Plan& plan);

}  // namespace opaline
