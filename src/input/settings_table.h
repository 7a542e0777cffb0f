// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of `film` and `settings`, each with its member and the stages depending on it: a new setting is a
// member of scene.h and a row here.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "input/schema.h"
#include "values/value.h"

namespace opaline {

/// Stages with values of `film` and `settings` in their cache keys, beside the plan's.
enum class KeyedStage {
  samples,        ///< placed on a surface
  transfers,      ///< light of an area light at samples
  kernel,         ///< radial profile, split into near and far field
  exitance,       ///< surface cache
  walks,          ///< random walks
  cells,          ///< of the diffusion equation
  surfaces,       ///< light from surfaces, for bounces
  gathered,       ///< light gathered at samples
  view,           ///< camera hits
  view_surfaces,  ///< surface types there, and samples of lights
  view_near       ///< irradiance at surface points
};

/// Row of the schema, for a member of Owner.
template <class Owner>
struct Member {
  KeyInfo info;
  void (*read)(Owner& owner, const Value& value, double mm_per_unit);
  std::string (*json)(const Owner& owner);  ///< empty: not set
  std::vector<KeyedStage> stages = {};      ///< stages with the value in their keys
};

std::span<const Member<Film>> film_members();
std::span<const Member<Settings>> settings_members();
std::span<const Member<Laboratory>> laboratory_members();

/// Film and settings in the key of a stage, as text.
std::string settings_in_key(KeyedStage stage, const Scene& scene);

}  // namespace opaline
