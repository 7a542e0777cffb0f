# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of a GLB, from the keys of shapes and media in a scene file."""
from __future__ import annotations

import math
import os
import tempfile

import numpy as np


BY_JSON = ", except in a .json scene"
FORMATS = {b"\x89PNG": "image/png", b"\xff\xd8\xff": "image/jpeg"}


def mime_type(data):
    """Type of a PNG or JPEG image; None of others."""
    return next((name for start, name in FORMATS.items() if data.startswith(start)), None)


def factor_of(texture):
    """Three factors of a texture's values."""
    scale = texture.get("scale", 1.0)
    return scale if isinstance(scale, list) else [scale] * 3


def decoded(values):
    """Linear values of sRGB values."""
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def encoded(values):
    """sRGB values of linear values."""
    return np.where(values <= 0.0031308, values * 12.92, 1.055 * np.maximum(values, 0) ** (1 / 2.4) - 0.055)


def numbers_of(texture):
    """Texels of a texture of numbers, without its scale: height x width x 3. Raises opaline.Error for other formats."""
    linear = pixels_of(texture["texture"])
    is_float = texture["texture"].path.rstrip("]").lower().endswith((".exr", ".hdr"))
    return linear if is_float or texture.get("color_space") == "srgb" else encoded(linear)


def pixels_of(picture):
    """Linear pixels of an image as opaline reads it: height x width x 3."""
    from .. import read_image
    with tempfile.TemporaryDirectory(prefix="opaline-") as folder:
        path = os.path.join(folder, os.path.basename(picture.inner_name))
        with open(path, "wb") as file:
            file.write(picture.read())
        image = read_image(path)
        return np.array(image.color if "R" in image.channels else np.repeat(image.array[..., :1], 3, axis=2))


def matched_albedo(color, ior):
    """Albedo of an index-matched half space below a boundary, for its reflectance of transmitted light (Saunderson 1942).

    glTF's multiscatter colour knows no boundary. Internal diffuse reflectance: Egan & Hilgeman 1973.
    """
    inside = -1.44 / ior**2 + 0.71 / ior + 0.668 + 0.0636 * ior if ior > 1 else 0.0
    return [part / (1 - inside * (1 - part)) for part in color]


class GltfMaterials:
    """Adds materials and their images to a file; each once."""

    def __init__(self, glb, losses):
        self.glb, self.losses = glb, losses
        self.materials, self.textures = {}, {}

    def index_of(self, surface, mesh):
        """Index of the material of a part."""
        key = (id(surface), mesh.is_double_sided)
        if key not in self.materials:
            record = self.material(surface, mesh.path) | {"doubleSided": mesh.is_double_sided}
            self.materials[key] = (surface, self.glb.add("materials", record))
        return self.materials[key][1]

    def lose(self, kind):
        self.losses.add(kind + BY_JSON, self.owner)

    def material(self, surface, path):
        self.owner = surface.path or path
        self.extensions = {}
        self.record = {"name": surface.name} if surface.name else {}
        self.pbr = self.record.setdefault("pbrMetallicRoughness", {})
        keys = surface.medium if surface.medium is not None else surface.shape
        self.add_boundary(keys)
        if surface.medium is None:
            self.add_color(surface.shape["reflectance"])
        else:
            self.add_medium(surface.medium)
        if (normals := surface.shape.get("normal_map")) is not None:
            scale = normals.get("scale", 1.0)
            self.add_texture(self.record, "normalTexture", normals, {} if scale == 1 else {"scale": scale})
        if self.extensions:
            self.record["extensions"] = self.extensions
            for name in self.extensions:
                self.glb.use(name)
        return self.record

    def add_color(self, color):
        """Base colour. It needs no factor above 1: such texels are brighter than white."""
        factor = color
        if isinstance(color, dict):
            factor = factor_of(color)
            self.add_texture(self.pbr, "baseColorTexture", color)
            if color.get("color_space") == "linear":
                self.lose("linear texels of colours")
        elif not isinstance(color, list):
            factor = [color] * 3
        if max(factor) > 1:
            self.lose("colours of textures above 1")
        self.pbr["baseColorFactor"] = [min(part, 1.0) for part in factor] + [1.0]

    def add_boundary(self, keys):
        roughness, metalness = keys.get("specular_roughness", 1.0), keys.get("metalness", 0.0)
        for name, value in (("roughnessFactor", roughness), ("metallicFactor", metalness)):
            self.pbr[name] = min(factor_of(value)[0], 1.0) if isinstance(value, dict) else value
        if isinstance(roughness, dict) or isinstance(metalness, dict):
            self.add_roughness(roughness, metalness)
        ior = keys.get("specular_ior", 1.5)
        if ior < 1:
            self.lose("indices of refraction below 1")
        elif ior != 1.5:
            self.extensions["KHR_materials_ior"] = {"ior": ior}
        weight = keys.get("specular_weight", 1.0 if "specular_roughness" in keys else 0.0)  # 0: diffuse alone
        if weight != 1:
            self.extensions["KHR_materials_specular"] = {"specularFactor": weight}
        if "fuzz_weight" in keys:
            self.extensions["KHR_materials_sheen"] = {
                "sheenColorFactor": [part * keys["fuzz_weight"] for part in keys["fuzz_color"]],
                "sheenRoughnessFactor": keys["fuzz_roughness"]}

    def add_roughness(self, roughness, metalness):
        """One texture with roughness in green and metalness in blue: the given one, or one made of both."""
        given = [(value, channel) for value, channel in ((roughness, "g"), (metalness, "b")) if isinstance(value, dict)]
        mapped = [{key: value for key, value in texture.items() if key.startswith("uv") or key == "texture"}
                  for texture, _ in given]
        if all(texture.get("channel", "r") == channel for texture, channel in given) and mapped[0] == mapped[-1]:
            self.add_texture(self.pbr, "metallicRoughnessTexture", given[0][0])
            return
        if any({**mapped[0], "texture": 0} != {**other, "texture": 0} for other in mapped):
            self.lose("metalness by other UVs than roughness")
            given = given[:1]
        data = self.packed(given)
        if data is not None:
            self.add_texture(self.pbr, "metallicRoughnessTexture", given[0][0], data=data)

    def packed(self, given):
        """PNG of the channels of textures, or None."""
        from .. import Error, image
        channels = []
        for texture, target in given:
            if texture.get("channel") == "a":
                self.lose("roughness and metalness in alpha, not packed in green and blue")
                return None
            if texture["texture"].is_tiled:
                self.lose("roughness and metalness of several tiles, not packed in green and blue")
                return None
            try:
                source = numbers_of(texture)
            except Error:
                self.lose("textures of roughness and metalness other than PNG, EXR and HDR, not packed in green and blue")
                return None
            channels.append((source[..., "rgba".find(texture.get("channel", "r"))], "rgb".find(target)))
        height, width = max((channel.shape for channel, _ in channels), key=lambda size: size[0])
        pixels = np.ones((height, width, 3), np.float32)
        for channel, target in channels:
            rows, columns = (np.arange(size) * channel.shape[axis] // size for axis, size in enumerate((height, width)))
            pixels[..., target] = channel[rows[:, None], columns]
        with tempfile.TemporaryDirectory(prefix="opaline-") as folder:
            path = os.path.join(folder, "packed.png")
            image(decoded(pixels).astype(np.float32), ["R", "G", "B"]).write(path, view="srgb")
            with open(path, "rb") as file:
                return file.read()

    def add_medium(self, medium):
        """A volume: attenuation over the shortest mean free path, and the colour of multiple scattering."""
        color, radius = medium["subsurface_color"], medium["subsurface_radius"]
        if isinstance(color, dict) or isinstance(radius, dict):
            self.lose("textures of subsurface_color and subsurface_radius")
        color = [0.5] * 3 if isinstance(color, dict) else color
        radius = factor_of(radius) if isinstance(radius, dict) else radius
        shortest = max(min(radius), 1e-9)
        self.extensions |= {
            "KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationDistance": shortest / 1000,
                                     "attenuationColor": [math.exp(-shortest / max(length, 1e-9)) for length in radius]},
            "KHR_materials_volume_scatter": {"multiscatterColor": matched_albedo(color, medium["specular_ior"]),
                                             "scatterAnisotropy": medium["subsurface_scatter_anisotropy"]},
        }
        weight = medium.get("subsurface_weight", 1.0)
        if isinstance(weight, dict):
            self.lose("textures of subsurface_weight")
            weight = 1.0
        self.extensions["KHR_materials_diffuse_transmission"] = {"diffuseTransmissionFactor": weight}
        self.add_color(medium.get("base_color", [1.0] * 3))

    def add_texture(self, owner, key, texture, extra={}, data=None):
        index = self.texture(texture["texture"], data)
        if index is None:
            return
        info = {"index": index} | extra
        transform = {name.removeprefix("uv_"): texture[name] for name in ("uv_scale", "uv_offset") if name in texture}
        if texture.get("uv_rotation"):
            transform["rotation"] = math.radians(texture["uv_rotation"])
        if transform:
            info["extensions"] = {"KHR_texture_transform": transform}
            self.glb.use("KHR_texture_transform")
        owner[key] = info

    def texture(self, picture, data):
        """Index of a texture, or None if glTF cannot hold its image."""
        key = (picture, data)
        if key in self.textures:
            return self.textures[key]
        self.textures[key] = None
        data = data if data is not None or picture.is_tiled else picture.read()
        mime = mime_type(data) if data else None
        if mime is None:
            self.losses.add("textures other than PNG and JPEG" + BY_JSON, picture.path)
            return None
        name = os.path.splitext(os.path.basename(picture.inner_name))[0]
        number = self.glb.add("images", {"name": name, "bufferView": self.glb.view(data), "mimeType": mime})
        self.textures[key] = self.glb.add("textures", {"source": number})
        return self.textures[key]
