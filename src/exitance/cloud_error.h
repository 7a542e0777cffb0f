// SPDX-License-Identifier: GPL-3.0-or-later
// Error of sums over samples, from trial sums at a few of them.
#pragma once

#include "exitance/evaluate.h"

namespace opaline {

/// Width of the comparison's near field, over the default.
inline constexpr double kWiderField = 1.41421356;

struct CloudErrorInput {
  const Octree& octree;
  const SplitKernel& kernel;
  const SplitKernel& wider;                            ///< the same for kWiderField times the spacing
  EvaluatorKind evaluator = EvaluatorKind::dual_tree;  ///< as EvaluateInput's
  double tolerance = 0.005;
  double max_solid_angle = 0.05;
  InstructionSet instruction_set = InstructionSet::automatic;
  std::array<float, 3> light_from_points{};  ///< fraction of the light from lights without area
};

/// Estimates the errors of a cloud of samples, from two trials. Sums at some 64 points are compared with a
/// near field sqrt(2) times as wide, whose flatness error is twice as large and whose interpolated irradiance
/// is smoother: the difference is about the error. A much smaller tolerance likewise gives the tree's error.
/// The roughness is the deviation of 512 samples' irradiance from their neighbours' mean.
CloudError tell_cloud_error(const CloudErrorInput& input);

}  // namespace opaline
