// SPDX-License-Identifier: GPL-3.0-or-later
// Components of the error, each isolated by two images differing in one setting.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/picture_error.h"
#include "opaline/scene.h"

namespace opaline {

/// Both images use `hierarchical` unless overridden; other settings are the scene's.
struct BudgetPart {
  std::string name;                    ///< "sampling"
  std::string setting;                 ///< text of the difference
  std::vector<std::string> here;       ///< overrides of the image with this component of the error
  std::vector<std::string> converged;  ///< overrides of the converged run
};

/// A measured component: figures of `here` against `converged`, two noise-free images, or the reason for
/// their absence.
struct BudgetRow {
  std::string scene;
  BudgetPart part;
  std::optional<PictureError> error;
  std::string failure;
};

/// in    planned_samples: of the group with the most; 0 (nothing translucent): no parts
std::vector<BudgetPart> error_budget(std::size_t planned_samples, const Settings& settings);

}  // namespace opaline
