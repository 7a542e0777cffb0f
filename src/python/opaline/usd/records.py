# SPDX-License-Identifier: GPL-3.0-or-later
"""The converted scene: lengths in stage units, y up, keys and values as in a scene file (scenes/README.md).

Three keys of texture objects are resolved by the writers: `texture` is a Picture, `uvs` the name of a primvar, and
`is_color` tells colours from numbers.
"""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Picture:
    """An image file; in a package, path is "asset.usdz[textures/a.png]"."""

    path: str

    @property
    def is_packed(self):
        return self.path.endswith("]")

    @property
    def is_tiled(self):
        return "<UDIM>" in self.path

    @property
    def inner_name(self):
        return self.path[self.path.rfind("[") + 1:].rstrip("]")

    def read(self):
        """Bytes of the file, or None."""
        from pxr import Ar
        asset = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(self.path))
        return bytes(asset.GetBuffer()) if asset else None


@dataclass
class Surface:
    """Keys of an opaque shape; with a medium, `shape` has only the maps of normals."""

    name: str
    path: str = ""
    shape: dict = field(default_factory=dict)
    medium: dict | None = None
    has_vertex_colors: bool = False  # displayColor multiplies its base colour

    def textures(self):
        """Its texture objects."""
        values = [*self.shape.values(), *(self.medium or {}).values()]
        return [value for value in values if isinstance(value, dict)]


@dataclass
class Part:
    """Triangles of one material: glTF attributes by name, and vertex indices (count x 3)."""

    attributes: dict[str, np.ndarray]
    triangles: np.ndarray
    surface: Surface


@dataclass
class Mesh:
    name: str
    path: str
    parts: list[Part]
    is_double_sided: bool


@dataclass
class Placed:
    """A mesh in the scene. matrix: to the world, 4 x 4 for column vectors."""

    name: str
    mesh: Mesh
    matrix: np.ndarray


@dataclass
class Scene:
    """Lights have two keys more: `path` of the prim, and `kind`, its plural."""

    mm_per_unit: float
    shapes: list[Placed] = field(default_factory=list)
    lights: list[dict] = field(default_factory=list)
    surroundings: list[float] | None = None
    surroundings_path: str = ""
    camera: dict | None = None
    camera_path: str = ""
    film: dict = field(default_factory=dict)
