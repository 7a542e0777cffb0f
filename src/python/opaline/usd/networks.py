# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of shader inputs: constants and image textures with their mapping."""
from __future__ import annotations

import math
import re

import numpy as np
from pxr import Sdf, UsdShade

from .records import Picture

VERTEX_COLORS = object()  # in place of a colour: the primvar displayColor
WRAPS = {"repeat", "periodic", "useMetadata"}
LINEAR_SPACES = {"raw", "Raw", "lin_rec709", "none", "lin_rec709_scene", "data"}
SRGB_SPACES = {"sRGB", "srgb_texture", "srgb_rec709_scene"}


def kind_of(shader):
    """Identifier of a shader without MaterialX's prefix, version and type: "image" of "ND_image_color3"."""
    name = shader.GetIdAttr().Get() or ""
    name = re.sub(r"_\d+$", "", name.removeprefix("ND_"))
    return re.sub(r"_(float|color[34]|vector[234]|surfaceshader)$", "", name)


def from_srgb(value):
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def plain(value):
    """A number, or a list of three, with the digits of a float."""
    if isinstance(value, (bool, int, float)):
        return float(str(np.float32(value)))
    return [float(str(np.float32(part))) for part in tuple(value)[:3]]


class Network:
    """Reads the inputs of one material's shader."""

    def __init__(self, material, shader, time, losses):
        self.material, self.shader, self.time, self.losses = material, shader, time, losses

    def lose(self, kind):
        self.losses.add(kind, self.material.GetPath())

    def source(self, shader, name):
        """The shader behind an input and the name of its output, or None without a connection to one."""
        attribute = self.attribute(shader, name)
        if attribute is None or UsdShade.Utils.GetType(attribute.GetName()) == UsdShade.AttributeType.Input:
            return None
        return UsdShade.Shader(attribute.GetPrim()), UsdShade.Utils.GetBaseNameAndType(attribute.GetName())[0]

    def attribute(self, shader, name):
        """The attribute with the value of an input, through interfaces, or None."""
        found = shader.GetInput(name)
        attributes = found.GetValueProducingAttributes() if found else []
        return attributes[0] if attributes else None

    def constant(self, shader, name, otherwise=None):
        """Value of an unconnected input."""
        attribute = self.attribute(shader, name)
        is_input = attribute is not None and UsdShade.Utils.GetType(attribute.GetName()) == UsdShade.AttributeType.Input
        value = attribute.Get(self.time) if is_input else None
        return otherwise if value is None else value

    def value(self, name, otherwise, is_color=False):
        """A number, a colour, a texture object or VERTEX_COLORS."""
        source = self.source(self.shader, name)
        if source is not None:
            found = self.node_value(*source, is_color)
            if found is None:
                self.lose(f"connections of {name} to {kind_of(source[0]) or 'a node without a kind'}")
            return otherwise if found is None else found
        value = self.constant(self.shader, name)
        if value is None:
            return otherwise
        return self.in_rec709(self.attribute(self.shader, name), plain(value), is_color)

    def number(self, name, otherwise):
        """A constant number; a texture is lost."""
        value = self.value(name, otherwise)
        if isinstance(value, float):
            return value
        if value is not otherwise:
            self.lose(f"textures of {name}")
        return otherwise

    def in_rec709(self, attribute, value, is_color):
        space = attribute.GetColorSpace() if is_color else ""
        if space in SRGB_SPACES:
            return [from_srgb(part) for part in value]
        if space and space not in LINEAR_SPACES:
            self.lose(f"the colour space {space}")
        return value

    def node_value(self, shader, output, is_color):
        kind = kind_of(shader)
        if kind == "UsdUVTexture":
            return self.preview_texture(shader, output, is_color)
        if kind in ("image", "tiledimage"):
            return self.materialx_texture(shader, is_color)
        if kind == "constant":
            value = self.constant(shader, "value")
            return None if value is None else self.in_rec709(self.attribute(shader, "value"), plain(value), is_color)
        if kind.startswith("separate") and output[-1:] in "rgba" and output.startswith("out"):
            source = self.source(shader, "in")
            texture = self.node_value(*source, is_color) if source is not None else None
            return texture | {"channel": output[-1]} if isinstance(texture, dict) else None
        name = self.constant(shader, "varname") or self.constant(shader, "geomprop")
        is_reader = kind.startswith("UsdPrimvarReader") or kind == "geompropvalue"
        return VERTEX_COLORS if is_reader and is_color and name == "displayColor" else None

    def picture(self, shader):
        """The file of a texture; None: missing, or without a name."""
        attribute = self.attribute(shader, "file")
        asset = attribute.Get(self.time) if attribute is not None else None
        if not isinstance(asset, Sdf.AssetPath) or not asset.path:
            return None
        path = asset.resolvedPath
        if UsdShade.UdimUtils.IsUdimIdentifier(asset.path):
            stack = attribute.GetPropertyStack(self.time)
            path = UsdShade.UdimUtils.ResolveUdimPath(asset.path, stack[0].layer) if stack else ""
        if not path:
            self.losses.add("missing textures", asset.path)
            return None
        return Picture(path)

    def preview_texture(self, shader, output, is_color):
        picture = self.picture(shader)
        if picture is None:
            value = self.constant(shader, "fallback")
            return None if value is None else plain(value) if is_color else float(value["rgba".find(output)])
        texture = {"texture": picture, "is_color": is_color}
        if output in tuple("rgba") and not is_color:
            texture["channel"] = output
        self.add_space(texture, self.constant(shader, "sourceColorSpace", "auto"))
        self.add_scale(texture, shader, output, is_color)
        for name in ("wrapS", "wrapT"):
            if (wrap := self.constant(shader, name, "useMetadata")) not in WRAPS:
                self.lose(f"the wrap mode {wrap} of textures; they repeat")
        return texture | self.mapping(shader, "st")

    def add_scale(self, texture, shader, output, is_color):
        scale, bias = (list(self.constant(shader, name, otherwise))
                       for name, otherwise in (("scale", [1] * 4), ("bias", [0] * 4)))
        if output == "rgb" and not is_color:  # a map of normals
            texture["scale"] = scale[0] / scale[2] if scale[2] > 0 else 1.0
            if scale[1] * scale[2] < 0:
                self.lose("maps of normals with green downwards")
            return
        if any(bias):
            self.lose("the bias of textures")
        own = scale[:3] if is_color else [scale["rgba".find(output)]]
        if any(factor != 1 for factor in own):
            texture["scale"] = [float(max(factor, 0)) for factor in own] if is_color else float(max(own[0], 0))

    def materialx_texture(self, shader, is_color):
        picture = self.picture(shader)
        if picture is None:
            value = self.constant(shader, "default")
            return None if value is None else plain(value)
        texture = {"texture": picture, "is_color": is_color}
        self.add_space(texture, self.attribute(shader, "file").GetColorSpace() or "auto")
        for name in ("uaddressmode", "vaddressmode"):
            if (wrap := self.constant(shader, name, "periodic")) not in WRAPS:
                self.lose(f"the wrap mode {wrap} of textures; they repeat")
        tiling = self.constant(shader, "uvtiling")
        offset = self.constant(shader, "uvoffset", (0, 0))
        if tiling is not None or any(offset):  # uv * tiling - offset
            scale = list(tiling or (1, 1))
            texture |= uv_keys(scale, 0, [-offset[0], -offset[1]])
        return texture | self.mapping(shader, "texcoord")

    def add_space(self, texture, space):
        if space in LINEAR_SPACES:
            texture["color_space"] = "linear"
        elif space in SRGB_SPACES:
            texture["color_space"] = "srgb"
        elif space != "auto":
            self.lose(f"the colour space {space}")

    def mapping(self, shader, name):
        """Keys for the UVs of a texture: the primvar and its transform."""
        source = self.source(shader, name)
        keys = {}
        if source is not None and kind_of(source[0]) == "UsdTransform2d":
            node = source[0]
            scale, turn, move = (self.constant(node, key, otherwise) for key, otherwise in
                                 (("scale", (1, 1)), ("rotation", 0), ("translation", (0, 0))))
            keys = uv_keys(scale, turn, move)
            source = self.source(node, "in")
        if source is None:
            return keys
        kind = kind_of(source[0])
        if kind.startswith("UsdPrimvarReader") or kind == "geompropvalue":
            primvar = self.constant(source[0], "varname") or self.constant(source[0], "geomprop")
            return keys | {"uvs": str(primvar)} if primvar else keys
        if kind != "texcoord":
            self.lose(f"UVs by {kind or 'a node without a kind'}")
        return keys


def uv_keys(scale, degrees, move):
    """Keys of a texture for UVs scaled, rotated counter-clockwise and moved, v upwards; those keys have v downwards."""
    sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    keys = {"uv_scale": [float(scale[0]), float(scale[1])], "uv_rotation": float(degrees),
            "uv_offset": [float(move[0] - sine * scale[1]), float(1 - move[1] - cosine * scale[1])]}
    return {} if keys == {"uv_scale": [1, 1], "uv_rotation": 0, "uv_offset": [0, 0]} else keys
