// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluation of keyframed values.
#pragma once

#include "values/json_tree.h"

namespace opaline {

/// Replaces every {"keyed": {"1": value, "24": value}, "between": "linear" | "spline"} in the tree by its
/// value at document.frame: numbers and lists of numbers are interpolated, and constant outside the keys.
/// Splines are cubic, with the slope at a key equal to that of the line between its neighbours (Catmull & Rom
/// 1974).
/// error Error{bad_input} at the value: no keys, a key other than a frame, values without interpolation
void resolve_keyed_values(Document& document);

/// The same, but values of the camera and of shapes at this time after the frame, in frames; those without interpolation
/// stay as in the frame.
void resolve_at_shutter(Document& document, double time);

/// Scene::camera_frames of an unresolved tree.
std::size_t count_camera_frames(const Document& document);

}  // namespace opaline
