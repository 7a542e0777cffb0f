// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of rough boundaries, made once and used by all renders of the program.
#pragma once

#include <memory>
#include <optional>

#include "transport/rough_boundary.h"

namespace opaline {

/// The same tables each time they are asked for: with an anisotropy they take seconds to make.
/// in    roughness: none: a range for any
std::shared_ptr<const RoughnessRange> shared_roughness(double eta, float anisotropy,
                                                       std::optional<float> roughness = {});

}  // namespace opaline
