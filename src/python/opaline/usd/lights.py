# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights as keys of a scene file: a radiance of 1 in USD is 1 W/(mm^2 sr)."""
from __future__ import annotations

import math

import numpy as np
from pxr import UsdLux

from .records import Picture

LEAST_ANGLE = 0.004  # degrees; less is a parallel light
DISC_SIDE = math.sqrt(math.pi) / 2  # side of a square over the diameter of a disc with the same area
KINDS = ("DistantLight", "SphereLight", "RectLight", "DiskLight", "DomeLight", "DomeLight_1")
UNUSED_KINDS = {"CylinderLight": "cylinder lights", "GeometryLight": "mesh lights", "PortalLight": "portal lights",
                "PluginLight": "lights of plugins"}


class LightReader:
    """Converts a light with its transform."""

    def __init__(self, prim, matrix, mm_per_unit, time, losses):
        self.prim, self.matrix, self.mm_per_unit, self.time, self.losses = prim, matrix, mm_per_unit, time, losses
        self.x, self.y, self.z, self.position = (matrix[:3, column] for column in range(4))
        self.lengths = [float(np.linalg.norm(axis)) for axis in (self.x, self.y, self.z)]

    def get(self, name, otherwise=None):
        attribute = self.prim.GetAttribute(name)
        value = attribute.Get(self.time) if attribute else None
        return otherwise if value is None else value

    def lose(self, kind):
        self.losses.add(kind, self.prim.GetPath())

    def brightness(self):
        color = [max(float(part), 0.0) for part in self.get("inputs:color", (1, 1, 1))]
        if self.get("inputs:enableColorTemperature", False):
            tint = UsdLux.BlackbodyTemperatureAsRgb(self.get("inputs:colorTemperature", 6500))
            color = [part * float(factor) for part, factor in zip(color, tint)]
        factor = self.get("inputs:intensity", 1.0) * 2 ** self.get("inputs:exposure", 0.0)
        return np.array(color) * max(factor, 0.0)

    def is_normalized(self):
        return bool(self.get("inputs:normalize", False))

    def keys(self):
        """Keys of one light, or None without emission."""
        brightness = self.brightness()
        if not brightness.any():
            return None
        kind = str(self.prim.GetTypeName())
        keys = getattr(self, kind.removesuffix("_1").removesuffix("Light").lower())(brightness)
        if any(self.get(f"inputs:{name}", 1.0) != 1 for name in ("diffuse", "specular")):
            self.lose("factors of lights on diffuse or specular light")
        if keys["type"] != "spot" and self.get("inputs:shaping:cone:angle", 90.0) < 90:
            self.lose("cones of lights other than spheres")
        if self.get("inputs:shaping:focus", 0.0) != 0 or self.get("inputs:shaping:ies:file"):
            self.lose("focus and IES files of lights")
        return {"name": self.prim.GetName()} | keys

    def direction(self):
        return (-self.z / self.lengths[2]).tolist()

    def distant(self, brightness):
        angle = self.get("inputs:angle", 0.53)
        if not self.is_normalized() and angle > 0:
            brightness = brightness * (math.pi * math.sin(math.radians(min(angle, 180) / 2)) ** 2)
        keys = {"type": "directional", "direction": self.direction(), "irradiance": brightness.tolist()}
        return keys | ({"angle": min(angle, 90.0)} if angle >= LEAST_ANGLE else {})

    def sphere(self, brightness):
        if max(self.lengths) > 1.001 * min(self.lengths):
            self.lose("unequal scales of sphere lights")
        radius = self.get("inputs:radius", 0.5) * float(np.prod(self.lengths)) ** (1 / 3)
        cone = self.get("inputs:shaping:cone:angle", 90.0)
        is_point = self.get("treatAsPoint", False) or radius <= 0
        flux_factor = math.pi * radius**2  # radiant intensity over radiance
        if self.is_normalized() or radius <= 0:
            brightness = brightness / (4 * math.pi * (radius**2 if radius > 0 else 1))
            flux_factor = flux_factor or math.pi
        intensity = (brightness * flux_factor * self.mm_per_unit**2).tolist()
        if cone < 90:
            softness = min(max(self.get("inputs:shaping:cone:softness", 0.0), 0.001), 1.0)
            if not is_point:
                self.lose("radii of spot lights")
            return {"type": "spot", "position": self.position.tolist(), "direction": self.direction(),
                    "intensity": intensity, "outer_angle": max(cone, 0.01), "inner_angle": max(cone, 0.01) * (1 - softness)}
        if is_point:
            return {"type": "point", "position": self.position.tolist(), "intensity": intensity}
        return {"type": "sphere", "center": self.position.tolist(), "radius": radius, "radiance": brightness.tolist()}

    def quad(self, brightness, width, height, area):
        u, v = self.x * width, -self.y * height  # u x v is -z
        if np.dot(np.cross(u, v), self.z) > 0:
            u, v = v, u
        if self.is_normalized():
            brightness = brightness / area
        return {"type": "quad", "corner": (self.position - u / 2 - v / 2).tolist(), "u": u.tolist(), "v": v.tolist(),
                "radiance": brightness.tolist()}

    def rect(self, brightness):
        if self.get("inputs:texture:file"):
            self.lose("textures of rectangle lights")
        width, height = self.get("inputs:width", 1.0), self.get("inputs:height", 1.0)
        return self.quad(brightness, width, height, float(np.linalg.norm(np.cross(self.x, self.y))) * width * height)

    def disk(self, brightness):
        """A square of the same area."""
        self.lose("round outlines of disk lights")
        side = 2 * self.get("inputs:radius", 0.5) * DISC_SIDE
        return self.quad(brightness, side, side, float(np.linalg.norm(np.cross(self.x, self.y))) * side**2)

    def dome(self, brightness):
        """An environment map, or even light from all sides (type `surroundings`)."""
        asset = self.get("inputs:texture:file")
        if not asset or not asset.path:
            return {"type": "surroundings", "radiance": brightness.tolist()}
        if not asset.resolvedPath:
            self.losses.add("missing textures", asset.path)
            return {"type": "surroundings", "radiance": brightness.tolist()}
        if self.get("inputs:texture:format", "automatic") not in ("automatic", "latlong"):
            self.lose("dome lights by another projection than latitude and longitude")
            return {"type": "surroundings", "radiance": brightness.tolist()}
        if self.y[1] / self.lengths[1] < 0.99999:
            self.lose("tilts of dome lights")
        # The centre of the image is at +z; about +y, +z turns towards +x.
        rotation = math.degrees(math.atan2(self.z[0], self.z[2]))
        return {"type": "environment", "file": Picture(asset.resolvedPath), "strength": brightness.tolist(),
                "rotation": rotation}


def dome_matrix(prim, matrix, to_y_up):
    """Transform of a dome light; DomeLight_1 may have its pole along the stage's up axis."""
    if prim.GetTypeName() != "DomeLight_1":
        return to_y_up @ matrix
    pole = prim.GetAttribute("poleAxis").Get()
    is_z = pole == "Z" or (pole == "scene" and not np.allclose(to_y_up, np.eye(4)))
    return to_y_up @ matrix @ (to_y_up.T if is_z else np.eye(4))
