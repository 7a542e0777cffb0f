// SPDX-License-Identifier: GPL-3.0-or-later
// Bias of near fields refined because of noise.
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
  std::span<const std::uint32_t> refined;  ///< indices returned by NearFieldSampler::refine, ascending
};

/// Signed error of the exitance, one per point, caused by noise: a point's near field is refined if its
/// irradiance differs from its neighbours' by chance: the other points keep theirs, and their mean is off.
/// in    points in an order in which neighbours follow each other
/// from  README.md of src/exitance, "Choices made by noise"
std::vector<RgbF> selection_bias(const SelectionBiasInput& input);

}  // namespace opaline
