# SPDX-License-Identifier: GPL-3.0-or-later
"""GLB files: meshes, and for a whole scene its materials, images, nodes, camera and lights."""
from __future__ import annotations

import json
import math
import struct

import numpy as np

from .gltf_materials import GltfMaterials

FLOAT, INTEGER = 5126, 5125
TYPES = {2: "VEC2", 3: "VEC3"}


class Glb:
    """A file under construction."""

    def __init__(self):
        self.document = {"asset": {"version": "2.0", "generator": "opaline-usd"}}
        self.chunks, self.size = [], 0

    def add(self, name, record):
        """Index of a new record in one of the document's lists."""
        self.document.setdefault(name, []).append(record)
        return len(self.document[name]) - 1

    def use(self, extension):
        names = self.document.setdefault("extensionsUsed", [])
        if extension not in names:
            names.append(extension)

    def view(self, data):
        padding = b"\0" * (-len(data) % 4)
        self.chunks.append(data + padding)
        self.size += len(data) + len(padding)
        return self.add("bufferViews", {"buffer": 0, "byteOffset": self.size - len(data) - len(padding),
                                        "byteLength": len(data)})

    def accessor(self, values, component, kind, **limits):
        return self.add("accessors", {"bufferView": self.view(np.ascontiguousarray(values).tobytes()), "count": len(values),
                                      "componentType": component, "type": kind} | limits)

    def primitive(self, part):
        attributes = {}
        for name, values in part.attributes.items():
            values = values.astype("<f4")
            limits = {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()} if name == "POSITION" else {}
            attributes[name] = self.accessor(values, FLOAT, TYPES[values.shape[1]], **limits)
        indices = self.accessor(part.triangles.astype("<u4").ravel(), INTEGER, "SCALAR")
        return {"attributes": attributes, "indices": indices}

    def bytes(self):
        self.document["buffers"] = [{"byteLength": self.size}]
        text = json.dumps(self.document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + self.size
        return b"".join([struct.pack("<4sII", b"glTF", 2, size), struct.pack("<I4s", len(text), b"JSON"), text,
                         struct.pack("<I4s", self.size, b"BIN\0"), *self.chunks])


def mesh_file(meshes):
    """Bytes of a GLB with these meshes alone, in their order."""
    glb = Glb()
    for mesh in meshes:
        primitives = [glb.primitive(part) for part in mesh.parts]
        glb.add("nodes", {"mesh": glb.add("meshes", {"name": mesh.name, "primitives": primitives})})
    glb.document |= {"scenes": [{"nodes": list(range(len(meshes)))}], "scene": 0}
    return glb.bytes()


def scene_file(scene, losses):
    """Bytes of a GLB with the whole scene, in metres. Parts without a counterpart in glTF are added to the losses."""
    glb = Glb()
    materials = GltfMaterials(glb, losses)
    metres = scene.mm_per_unit / 1000
    scale = np.diag([metres, metres, metres, 1])
    numbers = {}
    for shape in scene.shapes:
        mesh = shape.mesh
        if id(mesh) not in numbers:
            numbers[id(mesh)] = glb.add("meshes", {"name": mesh.name, "primitives": [
                glb.primitive(part) | {"material": materials.index_of(part.surface, mesh)} for part in mesh.parts]})
        glb.add("nodes", {"name": shape.name, "mesh": numbers[id(mesh)], "matrix": columns(scale @ shape.matrix)})
    add_camera(glb, scene, metres, losses)
    for light in scene.lights:
        add_light(glb, light, metres, losses)
    if scene.surroundings is not None:
        losses.add("dome lights, except in a .json scene", scene.surroundings_path)
    glb.document |= {"scenes": [{"nodes": list(range(len(glb.document["nodes"])))}], "scene": 0}
    return glb.bytes()


def columns(matrix):
    return matrix.T.ravel().tolist()


def looking(position, forward, up):
    """Columns of the matrix of a node at a position, looking along its -z."""
    backward = -np.array(forward) / np.linalg.norm(forward)
    right = np.cross(up, backward)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.stack([right, np.cross(backward, right), backward, position], axis=1)
    return columns(matrix)


def add_camera(glb, scene, metres, losses):
    keys, path = scene.camera, scene.camera_path
    if keys is None:
        return
    width, height = scene.film["resolution"]
    if "orthographic_height" in keys:
        size = keys["orthographic_height"] * metres / 2
        camera = {"type": "orthographic", "orthographic": {"xmag": size * width / height, "ymag": size, "znear": 0.0,
                                                           "zfar": 1e6}}
    else:
        camera = {"type": "perspective", "perspective": {"yfov": math.radians(keys["field_of_view"]),
                                                         "aspectRatio": width / height, "znear": 1e-3 * metres}}
    for key, kind in (("shift", "shifts of cameras"), ("aperture", "depth of field")):
        if key in keys:
            losses.add(f"{kind}, except in a .json scene", path)
    position = np.array(keys["position"])
    matrix = looking(position * metres, np.array(keys["look_at"]) - position, keys["up"])
    glb.add("nodes", {"name": path.rsplit("/", 1)[-1], "camera": glb.add("cameras", camera), "matrix": matrix})


def add_light(glb, light, metres, losses):
    """A punctual light: lux, and candela by metres; a sphere becomes a point."""
    kind, path = light["type"], light["path"]
    record = {"name": light["name"], "type": "point" if kind == "sphere" else kind}
    if kind not in ("directional", "point", "sphere", "spot"):
        losses.add(f"{light['kind']}, except in a .json scene", path)
        return
    if kind == "sphere" or "angle" in light:
        losses.add("sizes of lights and their soft shadows, except in a .json scene", path)
    if kind == "sphere":
        color = np.array(light["radiance"]) * (math.pi * (light["radius"] * metres) ** 2)
    else:
        color = np.array(light["irradiance"] if kind == "directional" else light["intensity"])
        color = color if kind == "directional" else color / 1e6
    intensity = float(color.max())
    record |= {"intensity": intensity, "color": (color / intensity).tolist()}
    if kind == "spot":
        record["spot"] = {"outerConeAngle": math.radians(light["outer_angle"]),
                          "innerConeAngle": math.radians(light["inner_angle"])}
    lights = glb.document.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
    lights.append(record)
    glb.use("KHR_lights_punctual")
    forward = light.get("direction", [0, 0, -1])
    up = [0, 1, 0] if abs(forward[1]) < 0.9 else [1, 0, 0]
    position = np.array(light.get("position", light.get("center", [0, 0, 0]))) * metres
    glb.add("nodes", {"name": light["name"], "matrix": looking(position, forward, up),
                      "extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}}})
