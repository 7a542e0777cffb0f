# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights of a stage without, as src/assets/add_defaults.cpp places them around an asset."""
from __future__ import annotations

import numpy as np

from .camera import DEFAULT_VIEW, ball_around

# Direction along the image's right, the world's up and towards the camera; radius over that of the shapes; radiance of a
# white diffuse surface at their center, facing the light.
LIGHTS = {"key": ((-0.7, 0.7, 0.7), 0.8, 0.52), "fill": ((0.9, 0.2, 0.8), 1.2, 0.16), "rim": ((0.3, 1, -0.8), 0.6, 0.35)}
DISTANCE = 4  # over the radius of the shapes
BACKDROP = 0.1
NEAR = 0.01  # fraction of the radius, or of a right angle


def default_lights(shapes, camera):
    """Keys `lights` and `backdrop` of a scene with this camera."""
    center, radius = ball_around(shapes)
    up = np.array([0.0, 1, 0])
    towards = np.array(camera["position"]) - center
    if not np.linalg.norm(np.cross(up, towards)) > NEAR * max(np.linalg.norm(towards), radius):
        towards = DEFAULT_VIEW
    axes = np.array([unit(np.cross(up, towards)), up, unit(towards)])
    lights = [{"name": name, "type": "sphere", "center": (center + unit(direction @ axes) * DISTANCE * radius).tolist(),
               "radius": size * radius, "radiance": white * (DISTANCE / size) ** 2, "visible": False}
              for name, (direction, size, white) in LIGHTS.items()]
    return {"lights": lights, "backdrop": BACKDROP}


def unit(vector):
    return vector / np.linalg.norm(vector)
