# SPDX-License-Identifier: GPL-3.0-or-later
"""Spheres, cubes and other solids of USD as triangles."""
from __future__ import annotations

import numpy as np
from pxr import UsdGeom

from .polygons import triangulate, unit_rows

AROUND, ALONG = 128, 64  # faces around the axis, and from pole to pole of a sphere
TURNS = {"X": [2, 0, 1], "Y": [1, 2, 0], "Z": [0, 1, 2]}  # from the axis z: where each coordinate comes from


def arc(radius, center, low, high, count):
    """Points (distance from the axis, height) and normals of an arc of a meridian, angles from the pole below."""
    angles = np.linspace(low, high, count + 1)
    normals = np.stack([np.sin(angles), -np.cos(angles)], axis=1).round(15)  # on the axis at the poles
    return radius * normals + [0, center], normals


def segment(start, end):
    """A straight piece of a meridian."""
    along = np.subtract(end, start)
    normal = np.array([along[1], -along[0]]) / np.linalg.norm(along)
    return np.array([start, end], float), np.array([normal, normal])


def revolve(pieces):
    """Points, normals and quads of pieces of a meridian, from below, around z."""
    angles = np.arange(AROUND) * (2 * np.pi / AROUND)
    points, normals, faces, offset = [], [], [], 0
    for meridian, directions in pieces:
        for source, out in ((meridian, points), (directions, normals)):
            out.append(np.stack([source[:, None, 0] * np.cos(angles), source[:, None, 0] * np.sin(angles),
                                 np.broadcast_to(source[:, None, 1], (len(source), AROUND))], axis=2).reshape(-1, 3))
        row, column = np.meshgrid(np.arange(len(meridian) - 1), np.arange(AROUND), indexing="ij")
        right = (column + 1) % AROUND
        quads = np.stack([row * AROUND + column, row * AROUND + right, (row + 1) * AROUND + right,
                          (row + 1) * AROUND + column], axis=2)
        faces.append(quads.reshape(-1, 4) + offset)
        offset += len(meridian) * AROUND
    return np.concatenate(points), np.concatenate(normals), np.concatenate(faces)


def box(size):
    """A cube around the origin, with a normal for each face."""
    points, normals, faces = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            normal = sign * np.eye(3)[axis]
            corners = [normal + a * u + sign * b * v for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            faces.append(np.arange(4) + len(points))
            points += corners
            normals += [normal] * 4
    return np.array(points) * size / 2, np.array(normals), np.array(faces)


def cylinder(bottom, top, height):
    low, high = -height / 2, height / 2
    pieces = [segment([0, low], [bottom, low])] if bottom > 0 else []
    pieces.append(segment([bottom, low], [top, high]))
    return revolve(pieces + ([segment([top, high], [0, high])] if top > 0 else []))


def sphere(radius):
    return revolve([arc(radius, 0, 0, np.pi, ALONG)])


def capsule(bottom, top, height):
    return revolve([arc(bottom, -height / 2, 0, np.pi / 2, ALONG // 2), segment([bottom, -height / 2], [top, height / 2]),
                    arc(top, height / 2, np.pi / 2, np.pi, ALONG // 2)])


def plane(width, length):
    points = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * [width / 2, length / 2, 0]
    return points, np.tile([0.0, 0, 1], (4, 1)), np.arange(4)[None]


# Name of the prim's type: function of its attributes, by name.
SOLIDS = {
    "Cube": (box, ("size",)),
    "Sphere": (sphere, ("radius",)),
    "Cylinder": (lambda radius, height: cylinder(radius, radius, height), ("radius", "height")),
    "Cylinder_1": (cylinder, ("radiusBottom", "radiusTop", "height")),
    "Cone": (lambda radius, height: cylinder(radius, 0, height), ("radius", "height")),
    "Capsule": (lambda radius, height: capsule(radius, radius, height), ("radius", "height")),
    "Capsule_1": (capsule, ("radiusBottom", "radiusTop", "height")),
    "Plane": (plane, ("width", "length")),
}


class Solid:
    """A solid with the interface of meshes.Geometry."""

    def __init__(self, prim, time):
        build, names = SOLIDS[prim.GetTypeName()]
        points, normals, faces = build(*(prim.GetAttribute(name).Get(time) for name in names))
        axis = prim.GetAttribute("axis")
        turn = TURNS[axis.Get(time) if axis else "Z"]
        self.points, self._normals = points[:, turn], unit_rows(normals)[:, turn]
        self.counts = np.full(len(faces), faces.shape[1])
        self.vertices = faces.ravel()
        self.triangles, self.faces = triangulate(self.points, self.counts, self.vertices)
        self.prim, self.time = prim, time

    def normals(self, _):
        return self._normals[self.vertices]

    def primvar(self, name, width):
        """A constant, or None."""
        primvar = UsdGeom.PrimvarsAPI(self.prim).FindPrimvarWithInheritance(name)
        values = primvar.ComputeFlattened(self.time) if primvar and primvar.HasValue() else None
        if values is None or len(values) != 1 or np.ndim(values) != 2:
            return None
        return np.repeat(np.array(values, float)[:, :width], len(self.vertices), axis=0)

    def uv_names(self):
        return []
