// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the error, each alone: two pictures that differ in one setting.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/picture_error.h"
#include "opaline/scene.h"

namespace opaline {

/// Both pictures are `hierarchical` unless a part's overrides say otherwise; what is not named is as the scene has it.
struct BudgetPart {
  std::string name;                    ///< "sampling"
  std::string setting;                 ///< text of the difference
  std::vector<std::string> here;       ///< overrides of the picture with this part of the error
  std::vector<std::string> converged;  ///< overrides of the converged run
};

/// A part as measured: the figures of `here` against `converged`, two pictures without noise, or why there
/// are none.
struct BudgetRow {
  std::string scene;
  BudgetPart part;
  std::optional<PictureError> error;
  std::string failure;
};

/// in    planned_samples: of the group with the most; 0 (nothing translucent): no parts
std::vector<BudgetPart> error_budget(std::size_t planned_samples, const Settings& settings);

}  // namespace opaline
