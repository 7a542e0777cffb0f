// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of `film` and `settings`, with their stages: a new setting is a member of scene.h and a row here.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "input/schema.h"
#include "values/value.h"

namespace opaline {

/// Stages with values of `film` and `settings` in their cache keys, beside the plan's (stages/stage_keys.h).
enum class KeyedStage {
  samples,
  transfers,  ///< from area lights
  kernel,
  exitance,  ///< surface caches
  walks,
  cells,
  surfaces,  ///< as light bounces from them
  gathered,  ///< bounced light at samples
  view,
  view_surfaces,
  view_near
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

/// Values of a section; defaults where missing.
template <class Owner>
Owner read_members(const Value& value, std::string_view section, std::span<const Member<Owner>> members,
                   double mm_per_unit) {
  const ObjectReader reader(value, section);
  Owner owner;
  for (const Member<Owner>& member : members)
    if (const std::optional<Value> given = reader.find(member.info.key))
      member.read(owner, *given, mm_per_unit);
  return owner;
}

/// Values of film and settings in the key of a stage.
std::string settings_in_key(KeyedStage stage, const Scene& scene);

}  // namespace opaline
