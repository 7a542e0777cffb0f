# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files: a JSON text, a GLB of its meshes, and images from packages beside it."""
from __future__ import annotations

import json
import os

from .camera import default_camera
from .default_lights import default_lights
from .glb import mesh_file
from .records import Picture
from .report import UsdError


class SceneFile:
    """A scene file under construction. files: bytes to be written beside it, by path."""

    def __init__(self, scene, path, losses):
        self.scene, self.losses = scene, losses
        self.folder = os.path.dirname(os.path.abspath(path))
        self.stem = os.path.splitext(os.path.basename(path))[0]
        self.media, self.media_names, self.files = {}, {}, {}
        self.used_names = {}

    def text(self):
        """The scene file; adds the files named in it."""
        meshes = list({id(shape.mesh): shape.mesh for shape in self.scene.shapes}.values())
        numbers = {id(mesh): number for number, mesh in enumerate(meshes)}
        mesh_name = f"{self.stem}.meshes.glb"
        self.files[mesh_name] = mesh_file(meshes)
        shapes = [keys for shape in self.scene.shapes for keys in self.shapes_of(shape, mesh_name, numbers[id(shape.mesh)])]
        camera = self.scene.camera or default_camera(self.scene.shapes)
        keys = {"mm_per_unit": self.scene.mm_per_unit, "camera": camera, "film": self.scene.film,
                "media": self.media, "shapes": shapes, "lights": [self.light(light) for light in self.scene.lights]}
        if self.scene.surroundings is not None:
            keys["surroundings"] = self.scene.surroundings
        elif not self.scene.lights:
            keys |= default_lights(self.scene.shapes, camera)
        return json.dumps(keys, indent=1)

    def shapes_of(self, shape, mesh_name, number):
        """Keys of a shape for each part. Parts of one medium are one body."""
        rows = shape.matrix[:3].tolist()
        parts = shape.mesh.parts
        all_keys = []
        for index, part in enumerate(parts):
            keys = {"name": self.unique(shape.name), "file": mesh_name, "part": f"{number}/{index}",
                    "transform": [{"matrix": rows}]} | self.resolved(part.surface.shape)
            if "NORMAL" not in part.attributes:
                keys["normals"] = "faceted"
            if part.surface.has_vertex_colors:
                keys["vertex_colors"] = True
            if part.surface.medium is not None:
                keys["medium"] = self.medium_name(part.surface)
            all_keys.append(keys)
        media = [keys.get("medium") for keys in all_keys]
        for keys in all_keys:
            if media.count(keys.get("medium")) > 1 and "medium" in keys:
                keys["group"] = f"{shape.name}/{keys['medium']}"
        return all_keys

    def unique(self, name):
        count = self.used_names[name] = self.used_names.get(name, 0) + 1
        return name if count == 1 else self.unique(f"{name}-{count}")

    def medium_name(self, surface):
        if id(surface) not in self.media_names:
            name, count = surface.name, 1
            while name in self.media:
                count += 1
                name = f"{surface.name}-{count}"
            self.media_names[id(surface)] = name
            self.media[name] = self.resolved(surface.medium)
        return self.media_names[id(surface)]

    def resolved(self, keys):
        """The keys with the names of image files."""
        return {key: self.texture(value) if isinstance(value, dict) else value for key, value in keys.items()}

    def texture(self, value):
        keys = {key: part for key, part in value.items() if key not in ("uvs", "is_color")}
        return keys | {"texture": self.file_name(value["texture"])}

    def file_name(self, picture):
        """Path from the scene file; an image of a package is copied."""
        if not picture.is_packed:
            return os.path.relpath(picture.path, self.folder)
        name = f"{self.stem}.textures/{picture.inner_name.replace('_', '__').replace('/', '_')}"
        if name not in self.files:
            data = picture.read()
            if data is None:
                raise UsdError(picture.path, "", "cannot be read")
            self.files[name] = data
        return name

    def light(self, light):
        keys = {key: value for key, value in light.items() if key not in ("path", "kind")}
        keys["name"] = self.unique(keys["name"])
        if isinstance(keys.get("file"), Picture):
            keys["file"] = self.file_name(keys["file"])
        return keys
