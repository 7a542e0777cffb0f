// SPDX-License-Identifier: GPL-3.0-or-later
// Keyed values in the JSON of a scene.
#pragma once

#include <set>
#include <string>

#include "core/log.h"

namespace opaline {

bool is_keyed(const Json& value);

/// Frames with a key of any keyed value of a parsed scene, or of a part of it.
std::set<int> key_frames(const Json& value);

/// Value at a path as in `--set`; null: missing.
const Json* value_at(const Json& scene, const std::string& path);

/// The value `now` with the keys of `value`: its keyed parts stay keyed, and changed ones get a key at the frame.
/// in    shown: `value` at the frame
Json with_keys(const Json& value, const Json& shown, const Json& now, int frame);

}  // namespace opaline
