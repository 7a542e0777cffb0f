// SPDX-License-Identifier: GPL-3.0-or-later
// Checks shared by all experiments of the laboratory.
#pragma once

#include <cstddef>

#include "transport/laboratory.h"

namespace opaline {

/// error Error{bad_input} naming the first setting out of its range
void check_settings(const LaboratorySettings& settings);

inline std::size_t walks_of_a_batch(const LaboratorySettings& settings) {
  return (settings.walks - 1) / kWalkBatches + 1;
}

}  // namespace opaline
