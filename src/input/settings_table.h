// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of `film` and `settings`, each with its member: a new setting is a member of scene.h and a row here.
#pragma once

#include <span>
#include <string>

#include "input/schema.h"
#include "values/value.h"

namespace opaline {

/// Row of the schema, for a member of Owner.
template <class Owner>
struct Member {
  KeyInfo info;
  void (*read)(Owner& owner, const Value& value, double mm_per_unit);
  std::string (*json)(const Owner& owner);  ///< empty: not set
};

std::span<const Member<Film>> film_members();
std::span<const Member<Settings>> settings_members();
std::span<const Member<Laboratory>> laboratory_members();

}  // namespace opaline
