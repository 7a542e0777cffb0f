// SPDX-License-Identifier: GPL-3.0-or-later
// Settings measured by a benchmark, from cheap to expensive along each knob.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace opaline {

/// One way to render a scene. Empty members but the method: as in the scene.
struct Rung {
  std::string method, evaluator;
  std::string knob, value;  ///< one more of the scene's settings
  bool of_media = false;    ///< the knob belongs to each medium, not to the settings
};

/// "hierarchical classic max_solid_angle=0.1"
std::string name_of(const Rung& rung);

/// For load_scene, in this order: "settings.method=hierarchical", ...
/// in    media: names of the scene's
std::vector<std::string> overrides_of(const Rung& rung, std::span<const std::string> media = {});

struct LadderInput {
  std::size_t planned_samples = 0;  ///< planned samples of the group with the most; 0: nothing is translucent
  bool quick = false;
  bool bounces = false;  ///< true if the scene has light between shapes
};

/// Rungs of a scene. The first is `lambert`, the baseline. Sample counts are 1/4, 1 and 4 times the plan's,
/// equal for all bodies. With light between shapes, all rungs gather it, and `direct`, the reference, traces
/// it from each entry point; one rung omits it.
std::vector<Rung> ladder(const LadderInput& input);

/// Runs compared with random walks: `lambert` first, then the scene as given, with each radial profile in
/// turn, and `volume_diffusion`.
std::vector<Rung> truth_ladder(bool quick);

}  // namespace opaline
