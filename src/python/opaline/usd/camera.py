# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras and render settings as keys of a scene file."""
from __future__ import annotations

import math

import numpy as np
from pxr import Sdf, UsdGeom, UsdRender

LONGER_SIDE = 512  # pixels, without render settings
SAMPLES_PER_PIXEL = 4
APERTURE_UNIT = 0.1  # stage units; of apertures and focal lengths
FIELD_OF_VIEW, MARGIN = 30, 1.05  # of the default camera: degrees, and radius of the visible sphere over the scene's

AZIMUTH, ELEVATION = math.radians(35), math.radians(20)
DEFAULT_VIEW = np.array([math.sin(AZIMUTH) * math.cos(ELEVATION), math.sin(ELEVATION), math.cos(AZIMUTH) * math.cos(ELEVATION)])


def render_settings(stage):
    """The render settings of a stage, or None."""
    path = stage.GetMetadata("renderSettingsPrimPath") if stage.HasMetadata("renderSettingsPrimPath") else None
    settings = UsdRender.Settings(stage.GetPrimAtPath(Sdf.Path(path))) if path else None
    return settings or None


def resolution_of(settings, aspect):
    """Width and height in pixels."""
    size = settings.GetResolutionAttr().Get() if settings else None
    if size is not None and min(size) > 0:
        return [int(size[0]), int(size[1])]
    if aspect >= 1:
        return [LONGER_SIDE, max(1, round(LONGER_SIDE / aspect))]
    return [max(1, round(LONGER_SIDE * aspect)), LONGER_SIDE]


def camera_keys(prim, matrix, settings, time):
    """Keys of `camera` and of `film`. The whole aperture is visible, as by the policy expandAperture."""
    camera = UsdGeom.Camera(prim)
    width, height, shift_x, shift_y, focal, f_stop, focus = (float(attribute.Get(time)) for attribute in (
        camera.GetHorizontalApertureAttr(), camera.GetVerticalApertureAttr(), camera.GetHorizontalApertureOffsetAttr(),
        camera.GetVerticalApertureOffsetAttr(), camera.GetFocalLengthAttr(), camera.GetFStopAttr(),
        camera.GetFocusDistanceAttr()))
    resolution = resolution_of(settings, width / height if height > 0 else 1)
    aspect = resolution[0] / resolution[1]
    width, height = max(width, height * aspect), max(height, width / aspect)
    up, backward = (matrix[:3, axis] / np.linalg.norm(matrix[:3, axis]) for axis in (1, 2))
    position = matrix[:3, 3]
    keys = {"position": position.tolist(), "look_at": (position - backward * (focus or 1)).tolist(), "up": up.tolist()}
    if camera.GetProjectionAttr().Get(time) == UsdGeom.Tokens.orthographic:
        keys["orthographic_height"] = height * APERTURE_UNIT
    else:
        keys["field_of_view"] = math.degrees(2 * math.atan2(height / 2, focal))
    if shift_x or shift_y:
        keys["shift"] = [shift_x / width, shift_y / height]
    if f_stop > 0 and focus > 0:
        keys |= {"aperture": focal * APERTURE_UNIT / f_stop, "focus_distance": focus}
    film = {"resolution": resolution, "samples_per_pixel": SAMPLES_PER_PIXEL}
    exposure = math.log2(max(camera.ComputeLinearExposureScale(time), 1e-30))
    return keys, film | ({"exposure": exposure} if exposure else {})


def default_camera(shapes):
    """A three-quarter view of all shapes."""
    center, radius = ball_around(shapes)
    position = center + DEFAULT_VIEW * (MARGIN * radius / math.sin(math.radians(FIELD_OF_VIEW) / 2))
    return {"position": position.tolist(), "look_at": center.tolist(), "field_of_view": FIELD_OF_VIEW}


def ball_around(shapes):
    """Center and radius of a ball around all vertices, the center that of their box."""
    ends = np.concatenate([to_world(shape) for shape in shapes])
    center = (ends.min(axis=0) + ends.max(axis=0)) / 2
    return center, max(float(np.linalg.norm(ends - center, axis=1).max()), 1e-12)


def to_world(shape):
    """Vertices of a placed mesh in the world."""
    points = np.concatenate([part.attributes["POSITION"] for part in shape.mesh.parts])
    return points @ shape.matrix[:3, :3].T + shape.matrix[:3, 3]
