# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of a view layer: their names in Blender, the layers they need, their pixels from the EXR."""

from dataclasses import dataclass
from typing import Callable

import bpy
import numpy as np

from . import conventions
from .scene_export import layer_name

BACKGROUND_DEPTH = 1e10  # as in Cycles
MATTE_LEVELS = 3
ALBEDO_PASS = "Diffuse Color" if bpy.app.version >= (5, 0, 0) else "DiffCol"
UNPLANNED_LAYERS = {"light_groups", "cryptomatte"}  # refused with a time budget
METHODS_WITH_ERROR = {"auto", "hierarchical", "volume_diffusion"}
METHODS_WITH_GROUPS = {"auto", "hierarchical", "lambert", "volume_diffusion"}


@dataclass
class Pass:
    """A pass; `pixels(picture, view)` returns its image, height x width x channels, from the top row."""

    name: str
    parts: str
    kind: str
    layers: tuple
    pixels: Callable


@dataclass
class View:
    """Values of the scene for the conversion of passes."""

    mm_per_unit: float
    position: np.ndarray  # y up, scene units
    forward: np.ndarray
    is_transparent: bool


def view_of(keys, is_transparent):
    """The view of an exported scene."""
    camera = keys["camera"]
    position = np.array(camera["position"])
    forward = np.array(camera["look_at"]) - position
    return View(keys["mm_per_unit"], position, forward / np.linalg.norm(forward), is_transparent)


def is_covered(picture):
    return picture.channels["A"] > 0


def combined(picture, view):
    """The image; opaque everywhere, as in Cycles, unless the film is transparent."""
    pixels = picture.layer("", "RGBA")
    if not view.is_transparent:
        pixels[..., 3] = 1
    return pixels


def depth(picture, view):
    """Distance along the view axis, in Blender units."""
    positions = picture.layer("P", "XYZ") / view.mm_per_unit
    distance = (positions - view.position) @ view.forward
    return np.where(is_covered(picture), distance, BACKGROUND_DEPTH)[..., None]


def normal(picture, view):
    del view
    return conventions.z_up(picture.layer("N", "XYZ"))


def position(picture, view):
    return conventions.z_up(picture.layer("P", "XYZ")) / view.mm_per_unit


def plain(layer, parts):
    """Pixels of a layer as it is in the file."""
    return lambda picture, view: picture.layer(layer, parts)


def light_group(light):
    """Sum of the diffuse, specular and visible light of one light."""
    def pixels(picture, view):
        del view
        parts = [picture.layer(f"{kind}_{layer_name(light)}", "RGB") for kind in ("diffuse", "specular", "emission")]
        found = [part for part in parts if part is not None]
        return sum(found) if found else None
    return pixels


def light_pass_name(light):
    return f"Light {light}"[:60]


def matte_passes(kind, levels):
    count = min((levels + 1) // 2, MATTE_LEVELS)
    return [Pass(f"{kind}{number:02d}", "RGBA", "COLOR", ("cryptomatte",), plain(f"{kind}{number:02d}", "RGBA"))
            for number in range(count)]


def wanted_passes(scene, view_layer, lights):
    """Passes of a view layer besides Combined. lights: names of the light groups."""
    method = scene.opaline.method
    settings = view_layer.opaline
    found = []
    if view_layer.use_pass_z:
        found.append(Pass("Depth", "Z", "VALUE", ("P",), depth))
    if view_layer.use_pass_normal:
        found.append(Pass("Normal", "XYZ", "VECTOR", ("N",), normal))
    if view_layer.use_pass_position:
        found.append(Pass("Position", "XYZ", "VECTOR", ("P",), position))
    if view_layer.use_pass_diffuse_color:
        found.append(Pass(ALBEDO_PASS, "RGB", "COLOR", ("albedo",), plain("albedo", "RGB")))
    if view_layer.use_pass_cryptomatte_object:
        found += matte_passes("CryptoObject", view_layer.pass_cryptomatte_depth)
    if view_layer.use_pass_cryptomatte_material:
        found += matte_passes("CryptoMaterial", view_layer.pass_cryptomatte_depth)
    if settings.use_pass_parts:
        found += [Pass("Diffuse", "RGB", "COLOR", ("diffuse",), plain("diffuse", "RGB")),
                  Pass("Specular", "RGB", "COLOR", ("specular",), plain("specular", "RGB"))]
    if settings.use_pass_error and method in METHODS_WITH_ERROR:
        found.append(Pass("Error", "RGB", "COLOR", ("error",), plain("error", "RGB")))
    if settings.use_pass_lights and method in METHODS_WITH_GROUPS:
        found += [Pass(light_pass_name(light), "RGB", "COLOR", ("light_groups",), light_group(light)) for light in lights]
    if scene.opaline.quality == "TIME_BUDGET":
        found = [each for each in found if not UNPLANNED_LAYERS & set(each.layers)]
    return found


def layers_of(passes):
    """Value of --layers for these passes."""
    names = sorted({layer for each in passes for layer in each.layers})
    return ",".join(names) if names else "none"


def matte_metadata(picture, view_layer):
    """Cryptomatte attributes of the EXR, with the names of the layers in Blender, as (field, value) pairs."""
    fields = []
    for name, value in picture.texts.items():
        if not (name.startswith("cryptomatte/") and name.endswith("/name")):
            continue
        prefix = name.removesuffix("name")
        full = f"{view_layer}.{value}"
        key = f"cryptomatte/{murmur3(full.encode()):08x}"[:19] + "/"
        fields.append((key + "name", full))
        for part in ("hash", "conversion", "manifest"):
            fields.append((key + part, picture.texts[prefix + part]))
    return fields


def murmur3(data):
    """MurmurHash3_32 of the Cryptomatte specification, with seed 0."""
    mask = 0xFFFFFFFF

    def mix(block):
        block = block * 0xCC9E2D51 & mask
        return ((block << 15 | block >> 17) & mask) * 0x1B873593 & mask

    value = 0
    whole = len(data) // 4 * 4
    for at in range(0, whole, 4):
        value ^= mix(int.from_bytes(data[at:at + 4], "little"))
        value = ((value << 13 | value >> 19) & mask) * 5 + 0xE6546B64 & mask
    if len(data) > whole:
        value ^= mix(int.from_bytes(data[whole:], "little"))
    value ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35), (16, 1)):
        value = (value ^ value >> shift) * factor & mask
    return value
