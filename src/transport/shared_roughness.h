// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of rough boundaries, shared by all renders of the program.
#pragma once

#include <memory>
#include <optional>

#include "transport/rough_boundary.h"

namespace opaline {

/// Returns the same tables on each call: anisotropic ones take seconds to compute.
/// in    roughness: none: a range for any
std::shared_ptr<const RoughnessRange> shared_roughness(double eta, float anisotropy,
                                                       std::optional<float> roughness = {});
std::shared_ptr<const AnisotropyRange> shared_anisotropies(double eta);

}  // namespace opaline
