// SPDX-License-Identifier: GPL-3.0-or-later
// Changes to a whole scene that leave most of it a scene.
#pragma once

#include <nlohmann/json.hpp>

#include "mutate_bytes.h"

namespace opaline::fuzz {

using Json = nlohmann::ordered_json;

/// One to four changes: numbers scaled by up to 1e30, values of other types, keys of the schema added or
/// removed, shapes, lights and transforms doubled, removed or made up, everything moved or scaled at once. in
/// scene: an object; film and samples are kept small
Json mutated_scene(Json scene, Random& random);

}  // namespace opaline::fuzz
