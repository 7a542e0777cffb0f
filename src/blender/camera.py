# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera and film."""

import math

import numpy as np

from . import conventions

MM_PER_LENS_UNIT = 1e-3  # Blender units per millimetre of focal length, for the lens diameter


class CameraError(ValueError):
    """The camera has no counterpart in a scene file."""


def unit(vector):
    return vector / np.linalg.norm(vector)


def camera_keys(camera_object, scene):
    """Keys of `camera`. Raises CameraError for a panorama."""
    camera = camera_object.data
    if camera.type not in {"PERSP", "ORTHO"}:
        raise CameraError("opaline renders perspective and orthographic cameras only")
    frame = np.array([corner[:] for corner in camera.view_frame(scene=scene)], float)
    low, high = frame.min(axis=0), frame.max(axis=0)
    width, height = high[:2] - low[:2]
    rows = np.array(conventions.matrix_rows(camera_object.matrix_world))
    up, backward, position = unit(rows[:, 1]), unit(rows[:, 2]), rows[:, 3]
    shift = [float((high[0] + low[0]) / 2 / width), float((high[1] + low[1]) / 2 / height)]
    keys = {"position": position.tolist(), "look_at": (position - backward).tolist(), "up": up.tolist()}
    if camera.type == "ORTHO":
        keys["orthographic_height"] = float(height)
    else:
        keys["field_of_view"] = math.degrees(2 * math.atan(height / 2 / abs(frame[0, 2])))
    if any(abs(part) > 1e-9 for part in shift):
        keys["shift"] = shift
    return keys | focus_keys(camera, position, -backward)


def focus_keys(camera, position, forward):
    """Depth of field: diameter of the lens, distance of the plane in focus and blades, as in Cycles."""
    focus = camera.dof
    if not focus.use_dof:
        return {}
    length = camera.lens * MM_PER_LENS_UNIT if camera.type == "PERSP" else 1.0
    distance = focus.focus_distance
    if focus.focus_object is not None:
        point = np.array(conventions.matrix_rows(focus.focus_object.matrix_world))[:, 3]
        distance = abs(float(np.dot(point - position, forward)))
    keys = {"aperture": float(length / max(focus.aperture_fstop, 1e-5)), "focus_distance": max(float(distance), 1e-5)}
    if focus.aperture_blades > 2:
        keys["blades"] = min(int(focus.aperture_blades), 100)
    return keys


def size_of(render):
    """Width and height of the whole image, in pixels."""
    percentage = render.resolution_percentage
    return max(1, render.resolution_x * percentage // 100), max(1, render.resolution_y * percentage // 100)


def border_of(render):
    """Rendered pixels [x0, y0, x1, y1] from the bottom left."""
    width, height = size_of(render)
    if not render.use_border:
        return [0, 0, width, height]
    x0, x1 = int(render.border_min_x * width), int(render.border_max_x * width)
    y0, y1 = int(render.border_min_y * height), int(render.border_max_y * height)
    return [x0, y0, max(x1, x0 + 1), max(y1, y0 + 1)]


def film_keys(render, samples):
    """Keys of `film`: size, region and camera rays per pixel."""
    width, height = size_of(render)
    keys = {"resolution": [width, height], "samples_per_pixel": samples, "pixel_type": "float"}
    if render.use_border:
        x0, y0, x1, y1 = border_of(render)
        keys["crop"] = [x0, height - y1, x1, height - y0]
    return keys
