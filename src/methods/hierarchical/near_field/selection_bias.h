// SPDX-License-Identifier: GPL-3.0-or-later
// The bias of near fields that are refined where noise asks for it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/evaluate.h"

namespace opaline {

struct SelectionBiasInput {
  std::array<float, 3> own_irradiance;     ///< SplitKernel's
  std::span<const RgbF> own;               ///< irradiance of each point, by few shadow rays
  std::span<const Exitance> exitance;      ///< exitance at each point
  std::span<const Rgb> noise;              ///< variance of the exitance because of `own`
  std::span<const std::uint32_t> refined;  ///< the points that NearFieldSampler chose, ascending
};

/// Signed error of the exitance, one a point, because a point's near field is refined when its irradiance
/// differs from its neighbours' by chance: the other points keep theirs, and their mean is off.
/// in    points in an order in which neighbours follow each other
/// from  README.md of src/exitance, "Choices made by noise"
std::vector<RgbF> selection_bias(const SelectionBiasInput& input);

}  // namespace opaline
