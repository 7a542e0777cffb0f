# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of node sockets: constants, and image textures with their mapping."""

import math

CONSTANT_NODES = {"RGB", "VALUE"}
SEPARATE_CHANNELS = {"Red": "r", "Green": "g", "Blue": "b", "R": "r", "G": "g", "B": "b"}


def source_of(socket):
    """The output linked to an input, through reroutes; None without a link."""
    while socket is not None and socket.is_linked and socket.links:
        origin = socket.links[0].from_socket
        if origin.node.type != "REROUTE":
            return origin
        socket = origin.node.inputs[0]
    return None


def input_named(node, name):
    """The input with this name, or None. Versions of Blender differ in their inputs."""
    return next((socket for socket in node.inputs if socket.name == name), None)


def constant_of(socket):
    """Default value of a socket: a number, or its first three as a list."""
    value = getattr(socket, "default_value", None)
    if value is None:
        return None
    return [float(part) for part in value[:3]] if hasattr(value, "__len__") else float(value)


def active_output(tree, kind):
    """The output node used for rendering: OUTPUT_MATERIAL, OUTPUT_WORLD or OUTPUT_LIGHT."""
    outputs = [node for node in tree.nodes if node.type == kind]
    return next((node for node in outputs if node.is_active_output), outputs[0] if outputs else None)


def nodes_before(socket):
    """All nodes upstream of an input, nearest first."""
    found, pending = [], [socket]
    while pending:
        origin = source_of(pending.pop(0))
        if origin is None or origin.node in found:
            continue
        found.append(origin.node)
        pending.extend(origin.node.inputs)
    return found


def color_attribute_of(socket):
    """Name of the colour attribute linked to a socket, "" for the one that the mesh renders with; None without a link."""
    origin = source_of(socket)
    if origin is None or origin.name != "Color":
        return None
    if origin.node.type == "VERTEX_COLOR":
        return origin.node.layer_name
    if origin.node.type == "ATTRIBUTE" and origin.node.attribute_type == "GEOMETRY":
        return origin.node.attribute_name or None
    return None


def uv_transform(mapping):
    """Keys of a texture for a Mapping node: glTF's transform of UVs with v downwards."""
    if mapping.vector_type != "POINT":
        return None
    location, rotation, scale = (constant_of(input_named(mapping, name)) for name in ("Location", "Rotation", "Scale"))
    if any(input_named(mapping, name).is_linked for name in ("Location", "Rotation", "Scale")) or any(rotation[:2]):
        return None
    angle = rotation[2]
    return {
        "uv_scale": [scale[0], scale[1]],
        "uv_rotation": math.degrees(angle),
        "uv_offset": [location[0] - math.sin(angle) * scale[1], 1 - location[1] - math.cos(angle) * scale[1]],
    }


class SocketReader:
    """Reads sockets of one material; unsupported links are warnings and leave the constant of the socket."""

    def __init__(self, owner, images, warn):
        self.owner = owner
        self.images = images
        self.warn = warn

    def texture(self, output):
        """A `texture` object for an output of an Image Texture, or None."""
        node, channel = output.node, None
        if node.type in {"SEPARATE_COLOR", "SEPRGB"} and getattr(node, "mode", "RGB") == "RGB":
            channel = SEPARATE_CHANNELS.get(output.name)
            output = source_of(node.inputs[0])
            if channel is None or output is None:
                return None
            node = output.node
        if node.type != "TEX_IMAGE" or node.image is None:
            return None
        path = self.images.path_of(node.image)
        if path is None:
            self.warn(f"{self.owner}: image '{node.image.name}' has no texels")
            return None
        texture = {"texture": path, "color_space": self.images.color_space_of(node.image)}
        if channel or output.name == "Alpha":
            texture["channel"] = channel or "a"
        vector = source_of(input_named(node, "Vector"))
        if vector is not None and vector.node.type == "MAPPING":
            transform = uv_transform(vector.node)
            if transform is None:
                self.warn(f"{self.owner}: the Mapping node of '{node.image.name}' is ignored")
            texture.update(transform or {})
            vector = source_of(input_named(vector.node, "Vector"))
        if vector is not None and (vector.node.type, vector.name) != ("TEX_COORD", "UV") and vector.node.type != "UVMAP":
            self.warn(f"{self.owner}: '{node.image.name}' uses UVs, not {vector.node.name} {vector.name}")
        return texture

    def image_of(self, socket):
        """The image behind a socket, or None."""
        origin = source_of(socket)
        node = origin.node if origin is not None else None
        if node is not None and node.type in {"SEPARATE_COLOR", "SEPRGB"}:
            origin = source_of(node.inputs[0])
            node = origin.node if origin is not None else None
        return node.image if node is not None and node.type == "TEX_IMAGE" else None

    def value(self, socket, may_be_texture=True):
        """A number, a colour, or a texture object for one."""
        origin = source_of(socket)
        if origin is None:
            return constant_of(socket)
        wants_color = hasattr(socket.default_value, "__len__")
        if origin.node.type in CONSTANT_NODES:
            value = constant_of(origin)
            if wants_color and not isinstance(value, list):
                return [value] * 3
            return value if wants_color or not isinstance(value, list) else sum(value) / 3
        texture = self.texture(origin) if may_be_texture else None
        if texture is None or (wants_color and "channel" in texture):
            self.warn(f"{self.owner}: {origin.node.name} is not exported; '{socket.name}' is constant")
            return constant_of(socket)
        return texture

    def number(self, socket, default=0.0):
        """A constant number."""
        return default if socket is None else self.value(socket, may_be_texture=False)
