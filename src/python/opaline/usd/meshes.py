# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as triangles with glTF attributes, a part for each material."""
from __future__ import annotations

import numpy as np
from pxr import UsdGeom, UsdShade

from . import solids
from .polygons import triangulate, unit_rows, vertex_normals
from .records import Mesh, Part
from .report import UsdError


class Geometry:
    """A mesh of USD: points, faces, and values at the corners of faces."""

    def __init__(self, prim, file, time):
        self.prim, self.file, self.time = prim, file, time
        mesh = UsdGeom.Mesh(prim)
        self.points = self.array(mesh.GetPointsAttr(), (3,), np.float64)
        self.counts = self.array(mesh.GetFaceVertexCountsAttr(), (), np.int64)
        self.vertices = self.array(mesh.GetFaceVertexIndicesAttr(), (), np.int64)
        self.check_faces()
        used = self.counts.copy()
        used[self.array(mesh.GetHoleIndicesAttr(), (), np.int64)] = 0
        self.triangles, self.faces = triangulate(self.points, self.counts, self.vertices)
        is_kept = used[self.faces] > 0
        self.triangles, self.faces = self.triangles[is_kept], self.faces[is_kept]
        if mesh.GetOrientationAttr().Get(time) == UsdGeom.Tokens.leftHanded:
            self.triangles = self.triangles[:, ::-1]

    def fail(self, message):
        raise UsdError(self.file, self.prim.GetPath(), message)

    def array(self, attribute, shape, kind):
        values = attribute.Get(self.time)
        return np.empty((0, *shape), kind) if values is None else np.array(values, kind).reshape(-1, *shape)

    def check_faces(self):
        if not np.isfinite(self.points).all():
            self.fail("points has an infinite or undefined value")
        if len(self.counts) and self.counts.min() < 0:
            self.fail(f"faceVertexCounts has {self.counts.min()}, expected 0 or more")
        if self.counts.sum() != len(self.vertices):
            self.fail(f"faceVertexIndices has {len(self.vertices)} values, expected {self.counts.sum()}")
        if len(self.vertices) and not 0 <= self.vertices.min() <= self.vertices.max() < len(self.points):
            self.fail(f"faceVertexIndices has values from {self.vertices.min()} to {self.vertices.max()}, "
                      f"expected 0 to {len(self.points) - 1}")
        holes = self.array(UsdGeom.Mesh(self.prim).GetHoleIndicesAttr(), (), np.int64)
        if len(holes) and not 0 <= holes.min() <= holes.max() < len(self.counts):
            self.fail(f"holeIndices has values from {holes.min()} to {holes.max()}, expected 0 to {len(self.counts) - 1}")

    def at_corners(self, name, values, interpolation):
        """Values by their interpolation, one for each corner of the faces."""
        if interpolation == UsdGeom.Tokens.constant:
            expected, numbers = 1, np.zeros(len(self.vertices), int)
        elif interpolation == UsdGeom.Tokens.uniform:
            expected, numbers = len(self.counts), np.repeat(np.arange(len(self.counts)), self.counts)
        elif interpolation == UsdGeom.Tokens.faceVarying:
            expected, numbers = len(self.vertices), np.arange(len(self.vertices))
        else:
            expected, numbers = len(self.points), self.vertices
        if len(values) < expected:
            self.fail(f"{name} has {len(values)} values, expected {expected} ({interpolation})")
        if not np.isfinite(values).all():
            self.fail(f"{name} has an infinite or undefined value")
        return values[numbers]

    def primvar(self, name, width):
        """A primvar at the corners, or None."""
        primvar = UsdGeom.PrimvarsAPI(self.prim).FindPrimvarWithInheritance(name)
        values = primvar.ComputeFlattened(self.time) if primvar and primvar.HasValue() else None
        if values is None or np.ndim(values) != 2 or np.shape(values)[1] < width:
            return None
        return self.at_corners(primvar.GetName(), np.array(values, np.float64)[:, :width], primvar.GetInterpolation())

    def normals(self, is_cage):
        """Authored normals at the corners, or None: faceted."""
        mesh = UsdGeom.Mesh(self.prim)
        normals = self.primvar("normals", 3)
        if normals is None and mesh.GetNormalsAttr().HasValue():
            values = self.array(mesh.GetNormalsAttr(), (3,), np.float64)
            normals = self.at_corners("normals", values, mesh.GetNormalsInterpolation())
        if is_cage or normals is None:
            used = self.vertices[self.triangles]
            return vertex_normals(self.points, used)[self.vertices] if is_cage else None
        return unit_rows(normals)

    def uv_names(self):
        """Names of its primvars of texture coordinates, `st` first."""
        names = [primvar.GetPrimvarName() for primvar in UsdGeom.PrimvarsAPI(self.prim).FindPrimvarsWithInheritance()
                 if primvar.HasValue() and str(primvar.GetTypeName()) in
                 ("texCoord2f[]", "texCoord2h[]", "texCoord2d[]", "float2[]", "half2[]", "double2[]")]
        return sorted(names, key=lambda name: (name != "st", name))


def merged_corners(attributes, vertices, vertex_count):
    """For each corner, the first corner of its vertex if all attributes are equal, else itself."""
    corners = np.arange(len(vertices))
    first = np.zeros(vertex_count, int)
    first[vertices[::-1]] = corners[::-1]
    candidate = first[vertices]
    is_same = np.ones(len(vertices), bool)
    for values in attributes.values():
        is_same &= (values == values[candidate]).all(axis=1)
    return np.where(is_same, candidate, corners)


class MeshReader:
    """Converts meshes; the same mesh with the same materials once."""

    def __init__(self, file, time, materials, losses):
        self.file, self.time, self.materials, self.losses = file, time, materials, losses
        self.meshes, self.geometries = {}, {}

    def mesh_of(self, prim):
        """The mesh of a prim, or None without triangles."""
        source = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        bound = self.bound_materials(prim)
        key = (source.GetPath(), tuple((faces is None, material.GetPath()) for faces, material in bound))
        if key not in self.meshes:
            self.meshes[key] = self.read(prim, source, bound)
        return self.meshes[key]

    def bound_materials(self, prim):
        """Pairs of face numbers and a material (perhaps invalid); the last pair is for all other faces."""
        binding = UsdShade.MaterialBindingAPI(prim)
        pairs = []
        for subset in binding.GetMaterialBindSubsets():
            if subset.GetElementTypeAttr().Get() != UsdGeom.Tokens.face:
                self.losses.add("subsets of points or edges", subset.GetPath())
                continue
            faces = np.array(subset.GetIndicesAttr().Get(self.time) or [], np.int64)
            pairs.append((faces, UsdShade.MaterialBindingAPI(subset.GetPrim()).ComputeBoundMaterial()[0]))
        return [*pairs, (None, binding.ComputeBoundMaterial()[0])]

    def geometry_of(self, source):
        if source.GetPath() not in self.geometries:
            if source.IsA(UsdGeom.Mesh):
                self.geometries[source.GetPath()] = Geometry(source, self.file, self.time)
            else:
                self.geometries[source.GetPath()] = solids.Solid(source, self.time)
        return self.geometries[source.GetPath()]

    def read(self, prim, source, bound):
        geometry = self.geometry_of(source)
        if len(geometry.triangles) == 0:
            self.losses.add("meshes without faces", prim.GetPath())
            return None
        gprim = UsdGeom.Gprim(source)
        opacity = gprim.GetDisplayOpacityAttr().Get(self.time) if not bound[-1][1] else None
        part_of_face = np.full(len(geometry.counts), len(bound) - 1)
        for number, (faces, material) in enumerate(bound[:-1]):
            if len(faces) and not 0 <= faces.min() <= faces.max() < len(geometry.counts):
                raise UsdError(self.file, prim.GetPath(), f"a subset for {material.GetPath() or 'a material'} has faces "
                               f"{faces.min()} to {faces.max()}, expected 0 to {len(geometry.counts) - 1}")
            part_of_face[faces] = number
        if opacity and min(opacity) < 1:
            self.losses.add("opacity of meshes", prim.GetPath())
        parts = []
        for number, (_, material) in enumerate(bound):
            wanted = geometry.triangles[part_of_face[geometry.faces] == number]
            if len(wanted):
                parts.append(self.part(geometry, prim, wanted, self.materials.surface_of(material, prim)))
        return Mesh(prim.GetName(), str(prim.GetPath()), parts, bool(gprim.GetDoubleSidedAttr().Get(self.time)))

    def part(self, geometry, prim, corners, surface):
        is_cage = self.is_cage(geometry, prim)
        attributes = {"POSITION": geometry.points[geometry.vertices]}
        normals = geometry.normals(is_cage)
        if normals is not None:
            attributes["NORMAL"] = normals
        self.add_uvs(geometry, prim, surface, attributes)
        colors = geometry.primvar("displayColor", 3) if surface.has_vertex_colors else None
        if colors is not None:
            attributes["COLOR_0"] = colors
        merged = merged_corners(attributes, geometry.vertices, len(geometry.points))[corners]
        used, numbers = np.unique(merged, return_inverse=True)
        return Part({name: values[used].astype(np.float32) for name, values in attributes.items()},
                    numbers.reshape(-1, 3).astype(np.uint32), surface)

    def is_cage(self, geometry, prim):
        """A subdivision surface, except one by default with normals of its own."""
        scheme = UsdGeom.Mesh(prim).GetSubdivisionSchemeAttr() if prim.IsA(UsdGeom.Mesh) else None
        if scheme is None or scheme.Get(self.time) == UsdGeom.Tokens.none:
            return False
        if not scheme.HasAuthoredValue() and geometry.normals(False) is not None:
            return False
        self.losses.add("limit surfaces of subdivision cages; --set 'shapes.*.subdivide=2' rounds them", prim.GetPath())
        return True

    def add_uvs(self, geometry, prim, surface, attributes):
        """The UVs of the material's textures, or the first of the mesh."""
        wanted = [texture["uvs"] for texture in surface.textures() if texture.get("uvs")]
        names = list(dict.fromkeys(wanted)) or geometry.uv_names()[:1]
        if len(names) > 1:
            self.losses.add(f"textures with other UVs than {names[0]}", prim.GetPath())
        uvs = geometry.primvar(names[0], 2) if names else None
        if uvs is not None:
            attributes["TEXCOORD_0"] = uvs * [1, -1] + [0, 1]
        elif wanted:
            self.losses.add("textures of meshes without their UVs", prim.GetPath())
