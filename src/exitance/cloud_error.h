// SPDX-License-Identifier: GPL-3.0-or-later
// How far off sums over samples are, by trial sums at a few of them.
#pragma once

#include "exitance/evaluate.h"

namespace opaline {

/// How much wider the near field of the comparison is.
inline constexpr double kWiderField = 1.41421356;

struct CloudErrorInput {
  const Octree& octree;
  const SplitKernel& kernel;
  const SplitKernel& wider;                            ///< the same for kWiderField times the spacing
  EvaluatorKind evaluator = EvaluatorKind::dual_tree;  ///< as EvaluateInput's
  double tolerance = 0.005;
  double max_solid_angle = 0.05;
  InstructionSet instruction_set = InstructionSet::automatic;
  std::array<float, 3> light_from_points{};  ///< fraction of the light coming from lights without area
};

/// The sums beside some 64 samples are compared with those of a near field that is sqrt(2) times as wide, whose
/// plane is off a curved surface by twice as much and whose interpolated irradiance is smoother: the
/// difference is about the error. So much smaller a tolerance tells the tree's error; what the irradiance of
/// 512 samples is off their neighbours' mean, its roughness.
CloudError tell_cloud_error(const CloudErrorInput& input);

}  // namespace opaline
