# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated meshes as GLB files: one file per mesh, one primitive per material.

Blender's own glTF exporter reads the scene, not the evaluated objects of a render: it takes modifiers and visibility of the
viewport, changes the selection and is an operator, unsafe in the thread of a render. These files have the evaluated
mesh of the frame, with the modifiers of the render.
"""

import hashlib
import json
import os
import struct

import numpy as np

FLOAT, INTEGER = 5126, 5125
KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


def read_into(collection, attribute, count, kind, width):
    """An attribute of all elements of a collection as a numpy array, count x width."""
    values = np.empty(count * width, kind)
    collection.foreach_get(attribute, values)
    return values.reshape(count, width)


def corner_colors(mesh, vertex_of, name):
    """Linear colours of an attribute at the corners of the faces; black without it, as in Cycles."""
    layers = mesh.color_attributes
    number = layers.find(name) if name else layers.render_color_index
    if not 0 <= number < len(layers):
        return np.zeros((len(vertex_of), 3), np.float32)
    layer = layers[number]
    colors = read_into(layer.data, "color", len(layer.data), np.float32, 4)[:, :3]
    return colors if layer.domain == "CORNER" else colors[vertex_of]


def is_open(mesh):
    """True if an edge has one face."""
    return bool((np.bincount(read_into(mesh.loops, "edge_index", len(mesh.loops), np.int32, 1)[:, 0]) == 1).any())


def corner_attributes(mesh, vertex_of, with_tangents):
    """Attributes at the corners of the faces, by their glTF names."""
    count = len(mesh.loops)
    vertices = read_into(mesh.vertices, "co", len(mesh.vertices), np.float32, 3)
    attributes = {
        "POSITION": vertices[vertex_of],
        "NORMAL": read_into(mesh.corner_normals, "vector", count, np.float32, 3),
    }
    layers = mesh.uv_layers
    layer = next((uvs for uvs in layers if uvs.active_render), layers.active) if len(layers) else None
    if layer is not None:
        uvs = read_into(layer.uv, "vector", count, np.float32, 2)
        attributes["TEXCOORD_0"] = np.stack([uvs[:, 0], 1 - uvs[:, 1]], axis=1)
        if with_tangents:
            mesh.calc_tangents(uvmap=layer.name)
            tangents = read_into(mesh.loops, "tangent", count, np.float32, 3)
            signs = read_into(mesh.loops, "bitangent_sign", count, np.float32, 1)
            attributes["TANGENT"] = np.hstack([tangents, signs])
    return attributes


def merged_corners(attributes, vertex_of, vertex_count):
    """For each corner, the first corner of its vertex if all attributes are equal, else itself."""
    corners = np.arange(len(vertex_of), dtype=np.int32)
    first = np.empty(vertex_count, np.int32)
    first[vertex_of[::-1]] = corners[::-1]
    candidate = first[vertex_of]
    is_same = np.ones(len(corners), bool)
    for values in attributes.values():
        is_same &= (values == values[candidate]).all(axis=1)
    return np.where(is_same, candidate, corners)


def primitives_of(mesh, with_tangents, color_attributes=(None,)):
    """Triangles by material index: {index: (attributes, vertex indices)}, with equal corners of a vertex merged.

    color_attributes: by material index, the last for all further ones; None: without colours.
    """
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    if count == 0:
        return {}
    corners = read_into(mesh.loop_triangles, "loops", count, np.int32, 3)
    materials = read_into(mesh.loop_triangles, "material_index", count, np.int32, 1)[:, 0]
    vertex_of = read_into(mesh.loops, "vertex_index", len(mesh.loops), np.int32, 1)[:, 0]
    attributes = corner_attributes(mesh, vertex_of, with_tangents)
    colors = {name: corner_colors(mesh, vertex_of, name) for name in set(color_attributes) - {None}}
    merged = merged_corners(attributes | {("color", name): values for name, values in colors.items()}, vertex_of,
                            len(mesh.vertices))
    primitives = {}
    for material in np.unique(materials):
        wanted = merged[corners[materials == material].reshape(-1)]
        is_used = np.zeros(len(vertex_of), bool)
        is_used[wanted] = True
        number = np.cumsum(is_used) - 1
        part = {name: values[is_used] for name, values in attributes.items()}
        name = color_attributes[min(material, len(color_attributes) - 1)]
        if name is not None:
            part["COLOR_0"] = colors[name][is_used]
        primitives[int(material)] = (part, number[wanted].astype(np.uint32))
    return primitives


def glb_of(primitives):
    """Bytes of a GLB with one mesh of these primitives, in the order of the dict."""
    views, accessors, chunks, offset = [], [], [], 0

    def add(values, kind):
        nonlocal offset
        data = values.tobytes()
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(data)})
        accessor = {"bufferView": len(views) - 1, "componentType": kind, "count": len(values),
                    "type": KINDS[1 if values.ndim == 1 else values.shape[1]]}
        accessors.append(accessor)
        chunks.append(data)
        offset += len(data)
        return accessor, len(accessors) - 1

    parts = []
    for attributes, indices in primitives.values():
        names = {}
        for name, values in attributes.items():
            accessor, names[name] = add(np.ascontiguousarray(values, "<f4"), FLOAT)
            if name == "POSITION":
                accessor["min"], accessor["max"] = values.min(axis=0).tolist(), values.max(axis=0).tolist()
        parts.append({"attributes": names, "indices": add(indices.astype("<u4"), INTEGER)[1]})
    document = {"asset": {"version": "2.0"}, "meshes": [{"primitives": parts}], "nodes": [{"mesh": 0}],
                "scenes": [{"nodes": [0]}], "scene": 0, "accessors": accessors, "bufferViews": views,
                "buffers": [{"byteLength": offset}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(chunks)
    size = 12 + 8 + len(text) + 8 + len(binary)
    return (struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def has_finite(primitives):
    return all(np.isfinite(attributes["POSITION"]).all() for attributes, _ in primitives.values())


class MeshFiles:
    """Writes the mesh of each object once. The name of a file is a hash of its bytes."""

    def __init__(self, folder):
        self.folder = folder
        self.written = {}

    def parts_of(self, key, evaluated, with_tangents, color_attributes, depsgraph):
        """Path of the file, {material index: primitive} and is_open of an evaluated object; None without faces."""
        if key not in self.written:
            self.written[key] = self.write(evaluated, with_tangents, color_attributes, depsgraph)
        return self.written[key]

    def write(self, evaluated, with_tangents, color_attributes, depsgraph):
        mesh = evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)
        if mesh is None:
            return None
        try:
            primitives = primitives_of(mesh, with_tangents, color_attributes)
            has_border = is_open(mesh)
        finally:
            evaluated.to_mesh_clear()
        if not primitives or not has_finite(primitives):
            return None
        data = glb_of(primitives)
        path = os.path.join(self.folder, hashlib.sha1(data).hexdigest()[:16] + ".glb")
        if not os.path.exists(path):
            with open(path, "wb") as file:
                file.write(data)
        return path, {material: number for number, material in enumerate(primitives)}, has_border
