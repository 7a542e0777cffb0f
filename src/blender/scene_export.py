# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the scene of a dependency graph as a scene file with its meshes and images."""

import json
import os
import re

import numpy as np

from . import camera, conventions
from .images import ImageFiles
from .lights import environment_keys, light_keys
from .materials import MaterialReader
from .meshes import MeshFiles

SURFACE_TYPES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
UNSUPPORTED_TYPES = {"VOLUME", "POINTCLOUD", "CURVES", "GPENCIL", "GREASEPENCIL"}
RESERVED_LIGHTS = {"surroundings"}


class ExportError(ValueError):
    """The scene cannot be rendered."""


def mm_per_unit_of(scene):
    """Millimetres per Blender unit: from the panel, or from the scene's unit scale in metres."""
    own = scene.opaline.mm_per_unit if hasattr(scene, "opaline") else 0.0
    return own if own > 0 else 1000.0 * scene.unit_settings.scale_length


class UniqueNames:
    """Gives each name once; the next ones get a number."""

    def __init__(self, reserved=()):
        self.used = set(reserved)

    def take(self, name):
        unique, number = name, 1
        while unique in self.used:
            number += 1
            unique = f"{name}#{number}"
        self.used.add(unique)
        return unique


class SceneExport:
    """The scene file under construction."""

    def __init__(self, depsgraph, folder):
        self.depsgraph = depsgraph
        self.scene = depsgraph.scene_eval
        self.folder = folder
        self.mm_per_unit = mm_per_unit_of(self.scene)
        self.warnings = []
        self.images = ImageFiles(folder)
        self.meshes = MeshFiles(folder)
        self.materials = MaterialReader(self.images, self.mm_per_unit, self.warn)
        self.names = UniqueNames(RESERVED_LIGHTS)  # of shapes and lights: an emitting shape is a light
        self.media, self.shapes, self.lights = {}, [], []

    def warn(self, text):
        if text not in self.warnings:
            self.warnings.append(text)

    def add_instances(self):
        for instance in self.depsgraph.object_instances:
            if not instance.show_self:
                continue
            evaluated = instance.object
            if evaluated.type in SURFACE_TYPES:
                self.add_object(instance, evaluated)
            elif evaluated.type == "LIGHT":
                self.add_light(instance, evaluated)
            elif evaluated.type in UNSUPPORTED_TYPES:
                self.warn(f"{evaluated.name}: an object of type {evaluated.type.lower()} is not exported")

    def add_light(self, instance, evaluated):
        data = evaluated.data
        if data.type == "AREA" and getattr(getattr(data, "cycles", None), "is_portal", False):
            return
        name = self.names.take(evaluated.name_full)
        keys = light_keys(name, data, instance.matrix_world, self.mm_per_unit, evaluated.visible_camera, self.warn)
        if keys is not None:
            self.lights.append(keys)

    def add_object(self, instance, evaluated):
        surfaces = [self.materials.surface_of(slot.material) for slot in evaluated.material_slots]
        surfaces = surfaces or [self.materials.surface_of(None)]
        needs_tangents = any(surface.needs_tangents for surface in surfaces)
        key = evaluated.original.name_full if evaluated.original is not None else evaluated.name_full
        color_attributes = [surface.color_attribute for surface in surfaces]
        written = self.meshes.parts_of((evaluated.type, key), evaluated, needs_tangents, color_attributes, self.depsgraph)
        if written is None:
            return
        matrix = np.array(conventions.matrix_rows(instance.matrix_world))
        if abs(np.linalg.det(matrix[:, :3])) < 1e-30:
            self.warn(f"{evaluated.name}: scaled to nothing, not exported")
            return
        path, parts, is_open = written
        name = self.names.take(evaluated.name_full)
        shapes = []
        for material, number in parts.items():
            surface = surfaces[min(material, len(surfaces) - 1)]
            if not surface.is_hole:
                part_name = name if number == 0 else self.names.take(f"{name}/{number}")
                shapes.append(self.shape_keys(part_name, path, number, matrix, surface, evaluated))
        if is_open and any("emission" in shape for shape in shapes):
            self.warn(f"{name}: an open mesh emits on the side of its normals alone")
        self.join_bodies(name, shapes)
        self.shapes += shapes

    def shape_keys(self, name, path, number, matrix, surface, evaluated):
        keys = {"name": name, "file": os.path.basename(path), "part": f"0/{number}",
                "transform": [{"matrix": matrix.tolist()}]} | surface.shape
        if surface.medium is not None:
            self.media[surface.name] = surface.medium
            keys["medium"] = surface.name
        elif evaluated.is_shadow_catcher and "emission" in keys:
            self.warn(f"{name}: an emitting surface is no shadow catcher")
        elif evaluated.is_shadow_catcher:
            keys["shadow_catcher"] = True
        if not evaluated.visible_camera:
            keys["visible"] = False
        return keys

    def join_bodies(self, name, shapes):
        """Parts of one medium are one body; parts of several media are open meshes."""
        media = {shape["medium"] for shape in shapes if "medium" in shape}
        if len(media) > 1:
            self.warn(f"{name}: several media in one mesh, {', '.join(sorted(media))}; light does not cross between them")
        for medium in media:
            parts = [shape for shape in shapes if shape.get("medium") == medium]
            if len(parts) > 1:
                for shape in parts:
                    shape["group"] = f"{name}/{medium}"

    def add_world(self, keys):
        surroundings, environment = environment_keys(self.scene.world, self.images, self.warn)
        is_transparent = self.scene.render.film_transparent
        if surroundings is not None:
            keys["surroundings"] = surroundings
        if environment is not None:
            environment["name"] = self.names.take(environment["name"])
            self.lights.append(environment)
        if is_transparent and (surroundings is not None or environment is not None):
            keys["backdrop"] = 0

    def settings_keys(self):
        settings = self.scene.opaline
        keys = {"method": settings.method, "light_samples": settings.light_samples,
                "max_samples": settings.max_samples, "seed": settings.seed}
        if not settings.bounces:
            keys["bounces"] = 0
        if settings.method == "volume":
            keys["until_error"] = settings.until_error / 100
        return keys

    def keys(self, camera_object):
        if camera_object is None:
            raise ExportError("the scene has no camera")
        try:
            view = camera.camera_keys(camera_object, self.scene)
        except camera.CameraError as error:
            raise ExportError(str(error)) from error
        render = self.scene.render
        if abs(render.pixel_aspect_x - render.pixel_aspect_y) > 1e-6:
            self.warn("pixels are square; the pixel aspect is ignored")
        self.add_instances()
        if not self.shapes:
            raise ExportError("the scene has no surface to render")
        keys = {"mm_per_unit": self.mm_per_unit, "camera": view,
                "film": camera.film_keys(render, self.scene.opaline.samples), "settings": self.settings_keys()}
        self.add_world(keys)
        return keys | {"media": self.media, "shapes": self.shapes, "lights": self.lights}


def write_if_changed(path, text):
    """Writes a file unless it has this text: the live view shows each written file."""
    try:
        with open(path, encoding="utf-8") as file:
            if file.read() == text:
                return
    except OSError:
        pass
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def export_scene(depsgraph, folder, camera_object, name="scene.json"):
    """Writes the scene to a folder.

    Returns its path, its keys and the warnings. Raises ExportError if nothing can be rendered.
    """
    export = SceneExport(depsgraph, folder)
    keys = export.keys(camera_object)
    path = os.path.join(folder, name)
    write_if_changed(path, json.dumps(keys, indent=1))
    return path, keys, export.warnings


def light_names(keys):
    """Names of the lights of an exported scene, with those of emitting shapes."""
    return ([light["name"] for light in keys["lights"]] + (["surroundings"] if "surroundings" in keys else [])
            + [shape["name"] for shape in keys["shapes"] if "emission" in shape])


def layer_name(light):
    """Suffix of the layers of a light group: letters and digits, others replaced."""
    return re.sub(rb"[^A-Za-z0-9]", b"_", light.encode()).decode()
