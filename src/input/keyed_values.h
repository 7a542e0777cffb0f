// SPDX-License-Identifier: GPL-3.0-or-later
// Values that change from frame to frame, as they are at one.
#pragma once

#include "values/json_tree.h"

namespace opaline {

/// Replaces every {"keyed": {"1": value, "24": value}, "between": "linear" | "spline"} in the tree by its
/// value at document.frame: numbers and lists of numbers blend, constant before the first frame and after the
/// last. Splines run smoothly through the values: cubic, with the slope at a key that of the line between its
/// neighbours (Catmull & Rom 1974).
/// error Error{bad_input} at the value: no keys, a key that is no frame, values that cannot be blended
void resolve_keyed_values(Document& document);

/// Scene::camera_frames of a tree that is not resolved yet.
std::size_t count_camera_frames(const Document& document);

}  // namespace opaline
