# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of a stage to a GLB or a scene file."""
from __future__ import annotations

import os

import numpy as np
from pxr import UsdGeom, UsdLux

from . import camera, glb
from .lights import KINDS, UNUSED_KINDS, LightReader, dome_matrix
from .materials import MaterialReader
from .meshes import MeshReader
from .records import Placed, Scene
from .report import Losses, UsdError
from .scene_file import SceneFile
from .solids import SOLIDS
from .stage import PrimWalk, open_stage, pose_skins, time_of, to_y_up

UNUSED_TYPES = {"BasisCurves": "curves", "NurbsCurves": "curves", "HermiteCurves": "curves", "Points": "points",
                "NurbsPatch": "NURBS patches", "TetMesh": "tetrahedra", "Volume": "volumes"}
RESERVED_LIGHTS = {"surroundings"}


class StageReader:
    """Reads all prims of a stage into a Scene."""

    def __init__(self, stage, file, time, losses):
        self.stage, self.file, self.time, self.losses = stage, file, time, losses
        mm_per_unit = 1000 * UsdGeom.GetStageMetersPerUnit(stage)
        self.scene = Scene(mm_per_unit)
        self.axes = to_y_up(stage)
        self.meshes = MeshReader(file, time, MaterialReader(time, mm_per_unit, losses), losses)
        self.settings = camera.render_settings(stage)
        self.camera_matrices = {}

    def run(self, camera_path):
        pose_skins(self.stage, self.time)
        for prim, matrix in PrimWalk(self.stage, self.file, self.time).run():
            kind = str(prim.GetTypeName())
            if not np.isfinite(matrix).all():
                raise UsdError(self.file, prim.GetPath(), "has no finite transform")
            if prim.IsA(UsdGeom.Mesh) or kind in SOLIDS:
                self.add_mesh(prim, self.axes @ matrix)
            elif prim.IsA(UsdGeom.Camera):
                self.camera_matrices.setdefault(str(prim.GetPath()), (prim, self.axes @ matrix))
            elif kind in KINDS:
                self.add_light(prim, matrix, kind)
            elif kind in UNUSED_KINDS or kind in UNUSED_TYPES:
                self.losses.add(UNUSED_KINDS.get(kind) or UNUSED_TYPES[kind], prim.GetPath())
            if kind not in KINDS and prim.HasAPI(UsdLux.LightAPI) and kind not in UNUSED_KINDS:
                self.losses.add("mesh lights", prim.GetPath())
        if not self.scene.shapes:
            raise UsdError(self.file, "", "has no visible mesh")
        self.add_camera(camera_path)
        return self.scene

    def add_mesh(self, prim, matrix):
        if abs(np.linalg.det(matrix[:3, :3])) < 1e-30:
            self.losses.add("meshes scaled to nothing", prim.GetPath())
            return
        mesh = self.meshes.mesh_of(prim)
        if mesh is not None:
            self.scene.shapes.append(Placed(prim.GetName(), mesh, matrix))

    def add_light(self, prim, matrix, kind):
        to_world = dome_matrix(prim, matrix, self.axes) if kind.startswith("Dome") else self.axes @ matrix
        keys = LightReader(prim, to_world, self.scene.mm_per_unit, self.time, self.losses).keys()
        if keys is None:
            return
        path = str(prim.GetPath())
        if keys["type"] == "surroundings":
            before = self.scene.surroundings or [0.0] * 3
            self.scene.surroundings = [a + b for a, b in zip(before, keys["radiance"])]
            self.scene.surroundings_path = path
            return
        name = f"{keys['name']}-light" if keys["name"] in RESERVED_LIGHTS else keys["name"]
        names = {"RectLight": "rectangle lights", "DiskLight": "disk lights"}
        self.scene.lights.append(keys | {"name": name, "path": path, "kind": names.get(kind, "dome lights")})

    def add_camera(self, wanted):
        """The given camera, the one of the render settings, or the first."""
        targets = self.settings.GetCameraRel().GetForwardedTargets() if self.settings else []
        path = wanted or (str(targets[0]) if targets else next(iter(self.camera_matrices), None))
        if path is not None and path not in self.camera_matrices:
            names = ", ".join(self.camera_matrices) or "a stage with a camera"
            raise UsdError(self.file, path, f"is no visible camera, expected {names}")
        for other in self.camera_matrices:
            if other != path:
                self.losses.add("other cameras", other)
        if path is None:
            self.scene.film = {"resolution": camera.resolution_of(self.settings, 1),
                               "samples_per_pixel": camera.SAMPLES_PER_PIXEL}
            return
        prim, matrix = self.camera_matrices[path]
        self.scene.camera, self.scene.film = camera.camera_keys(prim, matrix, self.settings, self.time)
        self.scene.camera_path = path


def write_file(path, data):
    """Writes a file completely or not at all."""
    scratch = f"{path}.{os.getpid()}.tmp"
    try:
        os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
        with open(scratch, "wb") as file:
            file.write(data)
        os.replace(scratch, path)
    except OSError as error:
        if os.path.exists(scratch):
            os.remove(scratch)
        raise UsdError(path, "", f"cannot be written: {error.strerror}") from error


def convert_file(source, target, time, camera):
    """See opaline.usd.convert."""
    ending = os.path.splitext(target)[1].lower()
    if ending not in (".glb", ".json"):
        raise UsdError(target, "", "is no name of an output, expected .glb or .json")
    losses = Losses()
    stage = open_stage(source, losses)
    scene = StageReader(stage, source, time_of(stage, time), losses).run(camera)
    if ending == ".glb":
        write_file(target, glb.scene_file(scene, losses))
        return losses.lines()
    file = SceneFile(scene, target, losses)
    text = file.text()
    for name, data in file.files.items():
        write_file(os.path.join(file.folder, name), data)
    write_file(target, text.encode())
    return losses.lines()
