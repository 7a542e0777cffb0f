// SPDX-License-Identifier: GPL-3.0-or-later
// The settings at which a benchmark runs a scene, from cheap to dear along each knob.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace opaline {

/// One way to render a scene. All but the method may be empty: as the scene has it.
struct Rung {
  std::string method, evaluator;
  std::string knob, value;  ///< one more of the scene's settings
};

/// "hierarchical classic max_solid_angle=0.1"
std::string name_of(const Rung& rung);

/// For load_scene, in this order: "settings.method=hierarchical", ...
std::vector<std::string> overrides_of(const Rung& rung);

struct LadderInput {
  std::size_t planned_samples = 0;  ///< of the group with the most; 0: nothing is translucent
  bool quick = false;
};

/// The first rung is `lambert`, what all the others are measured against. Sample counts are a quarter of the
/// plan's, the plan's and four times that, the same for each group of the scene.
std::vector<Rung> ladder(const LadderInput& input);

}  // namespace opaline
