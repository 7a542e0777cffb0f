// SPDX-License-Identifier: GPL-3.0-or-later
// The settings at which a benchmark runs a scene, from cheap to dear along each knob.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace opaline {

/// One way to render a scene. All but the method may be empty: as the scene has it.
struct Rung {
  std::string method, evaluator;
  std::string knob, value;  ///< one more of the scene's settings
  bool of_media = false;    ///< the knob is one of each medium, not of the settings
};

/// "hierarchical classic max_solid_angle=0.1"
std::string name_of(const Rung& rung);

/// For load_scene, in this order: "settings.method=hierarchical", ...
/// in    media: names of the scene's
std::vector<std::string> overrides_of(const Rung& rung, std::span<const std::string> media = {});

struct LadderInput {
  std::size_t planned_samples = 0;  ///< planned samples of the group with the most; 0: nothing is translucent
  bool quick = false;
  bool bounces = false;  ///< true if the scene has light between things
};

/// The first rung is `lambert`, what all the others are measured against. Sample counts are a quarter of the
/// plan's, the plan's and four times that, the same for each group of the scene. Of a scene with light between things, which
/// all rungs gather and `direct`, their reference, traces from each place at which light enters, one rung is without.
std::vector<Rung> ladder(const LadderInput& input);

/// Runs compared with random walks: `lambert` first, then the scene as given, with each radial profile in turn, and
/// `volume_diffusion`.
std::vector<Rung> truth_ladder(bool quick);

}  // namespace opaline
